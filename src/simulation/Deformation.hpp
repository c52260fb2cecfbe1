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

  /// Beyond a tenth either is as large as what the theory leaves out: a rotation by 0.1 makes strains of
  /// 0.005, and forces are off by a tenth of what they are across.
  [[nodiscard]] bool isSmall() const { return strain <= 0.1 && rotation <= 0.1; }
};

/// "strain 0.12 %, rotation 0.3°".
std::string inWords(const Deformation& deformation);

/// Of body `body`. Precondition: it is elastic. Collective.
Deformation largestDeformation(const SolvedScene& solved, int body);

} // namespace epafi::simulation
