#pragma once

/// What is true of a scene: decided from K, f, B, c of the bodies in one piece by small dense algebra that
/// shares nothing with the program's own checks.

#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::test {

enum class Verdict {
  solved,
  noSolution,    ///< the load moves bodies without end
  notUnique,     ///< bodies may rest anywhere
  contradiction, ///< no displacement satisfies all of supports, joints and contacts
  wrongInput,    ///< refused while it is assembled
  notConverged   ///< none of the oracle's: stopped short of the tolerance
};

std::string toString(Verdict verdict);

struct Truth {
  Verdict verdict = Verdict::solved;
  std::string reason{};
  /// Also not unique, so that a message may say either.
  bool isFree = false;
  double energy = 0, energyScale = 0;          ///< the scale: energy of deformation and work of loads
  double force = 0;                            ///< Σ λ of contacts
  double forceScale = 0;                       ///< of loads and forces; 0 if forces are not unique
  std::vector<Eigen::VectorXd> displacement{}; ///< of each body at all its nodes
  double largest = 0;                          ///< displacement
};

/// \throws Uncertain if the scene is so near the border between two verdicts that neither is certain
Truth truthOf(const scene::Scene& scene);

} // namespace epafi::test
