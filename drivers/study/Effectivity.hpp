#pragma once

/// How near the estimated discretisation error is to the true one, on the scenes of xml/.

#include "epafi/base/Types.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace epafi::drivers {

/// A scene on one of its meshes. Errors in the energy norm relative to that of the solution.
struct EffectivityRow {
  std::string scene;
  int level = 0; ///< 0: the scene's own mesh, or a coarser one (EffectivityCase); refined so often
  double unknowns = 0;
  double estimated = 0, error = 0;
  double referenceUnknowns = 0;
  double referenceError = 0; ///< of the reference, contained in `error`

  [[nodiscard]] double effectivity() const { return estimated / error; }
};

struct EffectivityCase {
  std::string scene;   ///< xml/<scene>.xml
  int refinements = 2; ///< of the reference; with 1 its own error is that of order h
  double meshSize =
      1; ///< factor on the sizes that a geometry asks for, where its own mesh is too fine to be refined
};

/// Scenes whose problem is the same on all meshes: not `regions`, where a finer mesh follows the borders of the materials better.
std::vector<EffectivityCase> effectivityCases(bool quick);

/// Of the scene's mesh and, with a reference that is refined twice, of the mesh refined once. What is left of the true error
/// by the reference's own is added by extrapolation (AccuracyReference.hpp).
/// Collective. \throws InputError if the scene cannot be read, Error if an iteration does not converge.
std::vector<EffectivityRow> measureEffectivity(const EffectivityCase& which,
                                               const std::filesystem::path& scenes,
                                               const RCP<const Comm>& comm);

/// The text of accuracy_effectivity.csv, and a table to read.
std::string effectivityCsv(const std::vector<EffectivityRow>& rows);
std::string effectivityReport(const std::vector<EffectivityRow>& rows);

} // namespace epafi::drivers
