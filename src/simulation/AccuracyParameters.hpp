#pragma once

/// How accurate a run is to be, and what it may cost: the list Accuracy of a scene.

#include "epafi/simulation/Quantity.hpp"

#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>

#include <limits>

namespace epafi::simulation {

struct AccuracyParameters {
  /// How meshes are refined: where the error is, or everywhere.
  enum class Refinement { local, even };
  bool estimate = true;       ///< whether to estimate the error at the end
  bool requiresSmall = false; ///< whether a run that ends with large strains or rotations has failed
  GlobalOrdinal coarserFrom =
      12000;                   ///< unknowns from which on a coarser mesh is looked at first, without a target
  bool bound = false;          ///< whether to bound energy and error from both sides
  QuantityParameters quantity; ///< in place of the energy norm
  double target = 0;           ///< of the relative error; 0: as accurate as the scene's mesh
  Refinement refinement = Refinement::local;
  int order = 0;      ///< of the elements with local refinement; 0: chosen
  int maxLevels = 20; ///< meshes at most
  double maxUnknowns = std::numeric_limits<double>::infinity(); ///< no mesh with more is made
  double maxSeconds = std::numeric_limits<double>::infinity(); ///< no mesh is begun that would be ready later
  double maxBytes = std::numeric_limits<double>::infinity(); ///< no mesh is made that would take more memory

  /// Adds the list Accuracy to the schema of a scene file.
  static void addTo(Teuchos::ParameterList& schema);
  /// From a validated list Accuracy. \throws InputError if the target is no share.
  static AccuracyParameters from(const Teuchos::ParameterList& list);
};

} // namespace epafi::simulation
