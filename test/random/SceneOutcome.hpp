#pragma once

/// What the program makes of a scene, beside what is true of it.

#include "RandomScene.hpp"
#include "SceneOracle.hpp"

#include "epafi/base/Types.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::test {

struct Outcome {
  Verdict verdict = Verdict::solved;
  std::string reason{};
  double energy = 0, force = 0;
  int products = 0;
  std::vector<Eigen::VectorXd> displacement{};
};

/// Solves the scene that the list is. Collective over `comm`.
/// \param folder  of its meshes
Outcome outcomeOf(const Teuchos::ParameterList& list, const std::string& folder, const RCP<const Comm>& comm);

/// The scene of a list.
scene::Scene sceneOf(const Teuchos::ParameterList& list, const std::string& folder);

/// What is wrong with the outcome; empty if nothing is. \param withPlaces whether displacements are to be the
/// same, too
std::string faultOf(const Outcome& outcome, const Truth& truth, bool withPlaces);

} // namespace epafi::test
