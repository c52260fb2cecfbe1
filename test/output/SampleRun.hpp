#pragma once

#include "epafi/fetidp/solve/ContactSolution.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/qp/solve/SolveReport.hpp"
#include "epafi/scene/Scene.hpp"

#include <Tpetra_Vector.hpp>

namespace epafi::test {

/// Two membranes in contact, cut unevenly (and so that four ranks hold different numbers of subdomains);
/// names that no HDF5 path may have.
inline scene::Scene sampleScene() {
  scene::Scene scene;
  scene.title = "sample";
  scene::Body left;
  left.name = "left body";
  left.mesh.box = mesh::rectangle(0, 1, 0, 1);
  left.mesh.elements = {5, 4, 0};
  left.supports = {{"wall", "left", {0.0}}};
  left.decomposition.counts = {2, 2};
  scene::Body right = left;
  right.name = "right";
  right.mesh.box = mesh::rectangle(1, 3, 0, 1);
  right.mesh.elements = {6, 4, 0};
  right.supports = {};
  right.decomposition.counts = {3, 1};
  scene.bodies = {left, right};
  scene.contacts = {{"left/right", 0, "right", 1, "left", {}, 0.25}};
  return scene;
}

/// The linear field that the sample's displacement takes.
inline double sampleField(const Point& point) {
  return 1 + 2 * point[0] - 3 * point[1];
}

/// u = sampleField at all nodes; contact row k: multiplier k + 1, slack (k + 1)/10, active where k is even.
inline fetidp::ContactSolution sampleSolution(const model::Decomposition& decomposition) {
  const auto& problem = decomposition.problem;
  fetidp::ContactSolution solution;
  for (const auto& subdomain : problem.subdomains) {
    const auto& mesh = *decomposition.bodies[subdomain.body].mesh;
    Eigen::VectorXd u(static_cast<Eigen::Index>(subdomain.nodes.size()));
    for (std::size_t k = 0; k < subdomain.nodes.size(); ++k)
      u[k] = sampleField(mesh.point(subdomain.nodes[k]));
    solution.displacement.push_back(u);
  }
  const auto& map = problem.multiplierMap;
  solution.multiplier = rcp(new Vector(map));
  solution.slack = rcp(new Vector(map));
  solution.active = rcp(new Vector(map));
  for (GlobalOrdinal row = 0; row < problem.numInequalities; ++row) {
    if (!map->isNodeGlobalElement(row))
      continue;
    solution.multiplier->replaceGlobalValue(row, static_cast<double>(row + 1));
    solution.slack->replaceGlobalValue(row, static_cast<double>(row + 1) / 10);
    solution.active->replaceGlobalValue(row, row % 2 == 0 ? 1.0 : 0.0);
  }
  solution.energy = -0.5;
  solution.contactForce = 15;
  return solution;
}

inline qp::History sampleHistory() {
  return {{0, 0, qp::StepKind::start, 1.0, 0.5, 0.0, 3, 1},
          {1, 0, qp::StepKind::conjugateGradient, 0.1, 0.25, -2.5, 4, 2},
          {2, 1, qp::StepKind::expansion, 0.01, 0.125, -2.75, 4, 4},
          {3, 1, qp::StepKind::proportioning, 0.001, 0.0625, -2.875, 5, 5}};
}

} // namespace epafi::test
