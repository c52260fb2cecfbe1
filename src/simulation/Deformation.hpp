#pragma once

/// How far a body is deformed: whether the theory of small displacements, in which strains are linear in the
/// displacements and loads and normals keep their directions, may be taken for the truth.

#include "epafi/simulation/SolvedScene.hpp"

#include <string>

namespace epafi::simulation {

/// The largest over the elements' centres, of displacements u.
struct Deformation {
  double strain = 0;   ///< a principal one's magnitude, of (∇u + ∇uᵀ)/2
  double rotation = 0; ///< of the material, in radians: the length of ½ rot u

  static constexpr double doubtful = 0.1; ///< from there on strains of ½ % and forces by a tenth are left out
  static constexpr double large = 0.2;    ///< from there on strains of 2 %: the theory does not hold
  [[nodiscard]] bool isAbove(double limit) const { return strain > limit || rotation > limit; }
};

/// "strain 0.12 %, rotation 0.3°".
std::string inWords(const Deformation& deformation);

/// Of body `body`. Precondition: it is elastic. Collective.
Deformation largestDeformation(const SolvedScene& solved, int body);

} // namespace epafi::simulation
