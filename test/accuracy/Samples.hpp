#pragma once

/// Scenes and fields that several tests of this room look at.

#include "support/ElasticSample.hpp"

#include "epafi/model/Decompose.hpp"
#include "epafi/scene/ModelProblem.hpp"
#include "epafi/scene/Scene.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace epafi::accuracy::test {

using epafi::test::Field;
using epafi::test::Kind;
using epafi::test::kinds;
using epafi::test::solutionWith;
using epafi::test::stackedBlocks;
using epafi::test::TemporaryDirectory;

struct AccuracyTest : testing::Test {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  TemporaryDirectory directory{comm};

  /// u of a field on a decomposition.
  static std::vector<Eigen::VectorXd> displacement(const model::Decomposition& decomposition,
                                                   const Field& field) {
    return solutionWith(decomposition, field).displacement;
  }
};

/// One membrane on (0, 2) × (0, 1), held on the left, as a rectangle.
inline scene::Scene membrane(int elements, int counts) {
  scene::Body body;
  body.name = "membrane";
  body.mesh.box = mesh::rectangle(0, 2, 0, 1);
  body.mesh.elements = {2 * elements, elements, 0};
  body.supports.push_back({"left", "left", {0}});
  body.decomposition.counts = {counts, counts, 1};
  scene::Scene scene;
  scene.bodies.push_back(body);
  return scene;
}

} // namespace epafi::accuracy::test
