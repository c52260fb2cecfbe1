/// Several unknowns a node, some of them held: what an assembler adds up is what the dense sum says.

#include "Scenes.hpp"

#include "epafi/fem/SubdomainAssembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace epafi::fem {
namespace {

/// A plate that is held in y along its bottom and may slide in x: a kernel of one mode, nodes that are held
/// in part.
scene::Body slidingPlate() {
  scene::Body body = plainBody(); // 4 × 3 elements
  body.physics = Physics::planeStress;
  body.supports = {{"floor", "bottom", {std::nullopt, 1.5, std::nullopt}}};
  SolidLoad load = fem::loadInside("load", mesh::rectangle(0.3, 1.7, 0.1, 0.8), 2);
  load.value[1] = -5;
  body.loads = {load};
  return body;
}

/// K, f and the energy of the supports, added up element by element over all positions.
struct Dense {
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd load;

  Dense(const BodyModel& model, std::span<const GlobalOrdinal> elements,
        const std::vector<GlobalOrdinal>& nodes) {
    const Eigen::Index size = 2 * nodes.size();
    stiffness = Eigen::MatrixXd::Zero(size, size);
    load = Eigen::VectorXd::Zero(size);
    Eigen::MatrixXd k;
    Eigen::VectorXd f;
    std::array<GlobalOrdinal, 4> corners{};
    for (const GlobalOrdinal element : elements) {
      model.element(element, k, f);
      model.mesh().elementNodes(element, corners);
      const auto position = [&](Eigen::Index i) {
        const auto node = std::find(nodes.begin(), nodes.end(), corners[i / 2]);
        return 2 * (node - nodes.begin()) + i % 2;
      };
      for (Eigen::Index i = 0; i < 8; ++i) {
        load[position(i)] += f[i];
        for (Eigen::Index j = 0; j < 8; ++j)
          stiffness(position(i), position(j)) += k(i, j);
      }
    }
  }
};

void expectEqualToDense(const BodyModel& model, std::span<const GlobalOrdinal> elements,
                        const AssembledSubdomain& part) {
  const Dense dense(model, elements, part.nodes);
  const Eigen::VectorXd reduced = dense.load - dense.stiffness * part.data.prescribed;
  const Eigen::MatrixXd k = part.stiffness;
  const Eigen::Index n = part.unknownPosition.size();
  ASSERT_EQ(k.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int row = part.unknownPosition[i];
    EXPECT_EQ(part.unknownOf[row], i);
    EXPECT_EQ(part.data.prescribed[row], 0);
    EXPECT_NEAR(part.data.load[i] - part.data.reaction[i], reduced[row], 1e-12);
    EXPECT_EQ(part.kernel(i, 0), model.kernelValue(part.nodes[row / 2], row % 2, 0));
    for (Eigen::Index j = 0; j < n; ++j)
      EXPECT_EQ(k(i, j), dense.stiffness(row, part.unknownPosition[j]));
  }
  const Eigen::VectorXd& held = part.data.prescribed;
  EXPECT_NEAR(part.data.energyOffset(), 0.5 * held.dot(dense.stiffness * held) - dense.load.dot(held), 1e-12);
}

TEST(VectorModelTest, PartlySupportedNodesAreAssembledAsTheDenseSumSays) {
  const scene::Body body = slidingPlate();
  const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
  const BodyModel model(body, mesh);
  ASSERT_EQ(model.kernelDimension(), 1);
  SubdomainAssembler assembler(model);
  const std::vector<std::vector<GlobalOrdinal>> parts{
      {0, 1, 4, 5}, {2, 3, 6, 7}, {8, 9}, {10, 11}, {5, 4, 1, 0}, {3, 7, 11, 10, 2}, allElements(12)};
  for (const auto& elements : parts) {
    AssembledSubdomain part;
    assembler.assemble(elements, part);
    expectEqualToDense(model, elements, part);
  }
}

TEST(VectorModelTest, WhatAnAssemblerRemembersDoesNotShowInItsResults) {
  const scene::Body body = slidingPlate();
  const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
  const BodyModel model(body, mesh);
  ASSERT_EQ(model.kernelDimension(), 1);
  SubdomainAssembler assembler(model);
  AssembledSubdomain part; // overwritten again and again
  for (int round = 0; round < 2; ++round)
    for (const std::vector<GlobalOrdinal>& elements :
         {std::vector<GlobalOrdinal>{0, 1}, {2, 3}, {4, 5}, {0, 4}, {6, 7}, {10, 11}}) {
      assembler.assemble(elements, part);
      const AssembledSubdomain alone = assemble(model, elements);
      EXPECT_EQ(part.nodes, alone.nodes);
      EXPECT_EQ(part.borderNodes, alone.borderNodes);
      EXPECT_EQ(part.unknownOf, alone.unknownOf);
      EXPECT_EQ(part.unknownPosition, alone.unknownPosition);
      EXPECT_EQ(part.data.prescribed, alone.data.prescribed);
      EXPECT_EQ(Eigen::MatrixXd(part.stiffness), Eigen::MatrixXd(alone.stiffness));
      EXPECT_EQ(part.data.rightHandSide(), alone.data.rightHandSide());
      EXPECT_EQ(part.kernel, alone.kernel);
      EXPECT_EQ(part.data.energyOffset(), alone.data.energyOffset());
    }
}

} // namespace
} // namespace epafi::fem
