#pragma once

/// Problems of scenes, solved as they are and handed over by an application.

#include "HandedOver.hpp"
#include "Reference.hpp"

#include <memory>

namespace epafi::fetidp {

/// Two blocks in the plane or in space: one stands in a corner, the other slides on the floor, along the
/// wall, and is pressed against the first by its weight, which pulls it aside.
scene::Scene twoBlocks(int dimension, const scene::Decomposition& cut);

/// Membranes and blocks, held and floating, cut in several ways.
std::vector<decomposition::Case> handedCases();

/// A scene, solved as it is and as an application's problem.
struct Twice {
  Twice(const scene::Scene& scene, decomposition::Supports supports)
      : Twice(scene, supports, [&](Twice& twice) {
          twice.handed->setContact(decomposition::contactOf(scene, twice.direct.decomposition, supports));
        }) {}
  /// \param couple  enters what the bodies have to do with each other
  template <class Couple>
  Twice(const scene::Scene& scene, decomposition::Supports supports, const Couple& couple)
      : direct(scene, 1e-12),
        handed(decomposition::handOver(scene, decomposition::matricesOf(scene, supports))) {
    couple(*this);
    handed->complete();
    solver = std::make_unique<ContactSolver>(toleranceOf(1e-12));
    solver->setup(handed->problem(), handed->data());
    solution = solver->solve(handed->data());
  }
  /// Largest difference of the displacements, relative to the largest displacement. Collective.
  [[nodiscard]] double difference() const;

  Solved direct;
  std::unique_ptr<decomposition::UnassembledProblem> handed;
  std::unique_ptr<ContactSolver> solver;
  ContactSolution solution;
};

} // namespace epafi::fetidp
