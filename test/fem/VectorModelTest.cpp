/// Several unknowns a node: what elasticity will need, on a model that a reader checks by hand.

#include "Scenes.hpp"

#include "epafi/fem/SubdomainAssembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace epafi::fem {
namespace {

/// The membrane's matrices times a coupling of the components, K ⊗ C with C = [2 1; 1 3]; component 1 is held at
/// the nodes of the bottom, component 0 at node 0.
class CoupledModel final : public BodyModel {
public:
  CoupledModel(const scene::Body& body, const RectangleMesh& mesh) : membrane_(body, mesh) {}
  [[nodiscard]] const Mesh& mesh() const override { return membrane_.mesh(); }
  [[nodiscard]] int components() const override { return 2; }
  [[nodiscard]] int kernelDimension() const override { return 1; }
  [[nodiscard]] double kernelValue(GlobalOrdinal node, int component, int /*mode*/) const override {
    return static_cast<double>(10 * node + component);
  }
  [[nodiscard]] std::optional<double> prescribed(GlobalOrdinal node, int component) const override {
    if (node == 0 || (component == 1 && node <= 4))
      return 0.5 + component;
    return std::nullopt;
  }
  void prescribed(std::span<const GlobalOrdinal> nodes, std::vector<PrescribedValue>& values) const override {
    values.clear();
    for (std::size_t position = 0; position < 2 * nodes.size(); ++position)
      if (const auto value = prescribed(nodes[position / 2], static_cast<int>(position % 2)))
        values.push_back({position, *value});
  }
  void kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const override {
    membrane_.kinds(elements, kinds);
  }
  void stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const override {
    Eigen::MatrixXd k;
    membrane_.stiffness(kind, k);
    stiffness.resize(2 * k.rows(), 2 * k.cols());
    for (Eigen::Index i = 0; i < k.rows(); ++i)
      for (Eigen::Index j = 0; j < k.cols(); ++j)
        stiffness.block(2 * i, 2 * j, 2, 2) = k(i, j) * coupling_;
  }
  void loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const override {
    loads.resize(8, static_cast<Eigen::Index>(elements.size()));
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (Eigen::Index row = 0; row < 8; ++row)
        loads(row, static_cast<Eigen::Index>(e)) = static_cast<double>(elements[e] + row);
  }

private:
  MembraneModel membrane_;
  Eigen::Matrix2d coupling_{{2, 1}, {1, 3}};
};

/// K, f and the energy of the supports, added up element by element over all positions.
struct Dense {
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd load;

  Dense(const BodyModel& model, std::span<const GlobalOrdinal> elements,
        const std::vector<GlobalOrdinal>& nodes) {
    const auto size = static_cast<Eigen::Index>(2 * nodes.size());
    stiffness = Eigen::MatrixXd::Zero(size, size);
    load = Eigen::VectorXd::Zero(size);
    Eigen::MatrixXd k;
    Eigen::VectorXd f;
    std::array<GlobalOrdinal, 4> corners{};
    for (const GlobalOrdinal element : elements) {
      model.element(element, k, f);
      model.mesh().elementNodes(element, corners);
      const auto position = [&](Eigen::Index i) {
        const auto node = std::find(nodes.begin(), nodes.end(), corners[static_cast<std::size_t>(i / 2)]);
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
  const Eigen::VectorXd reduced = dense.load - dense.stiffness * part.prescribed;
  const Eigen::MatrixXd k = part.stiffness;
  const auto n = static_cast<Eigen::Index>(part.unknownPosition.size());
  ASSERT_EQ(k.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int row = part.unknownPosition[static_cast<std::size_t>(i)];
    EXPECT_EQ(part.unknownOf[static_cast<std::size_t>(row)], i);
    EXPECT_EQ(part.prescribed[row], 0);
    EXPECT_NEAR(part.load[i], reduced[row], 1e-12);
    EXPECT_EQ(part.kernel(i, 0),
              model.kernelValue(part.nodes[static_cast<std::size_t>(row / 2)], row % 2, 0));
    for (Eigen::Index j = 0; j < n; ++j)
      EXPECT_EQ(k(i, j), dense.stiffness(row, part.unknownPosition[static_cast<std::size_t>(j)]));
  }
  const Eigen::VectorXd& held = part.prescribed;
  EXPECT_NEAR(part.energyOffset, 0.5 * held.dot(dense.stiffness * held) - dense.load.dot(held), 1e-12);
}

TEST(VectorModelTest, PartlySupportedNodesAreAssembledAsTheDenseSumSays) {
  const scene::Body body = plainBody(); // 4 × 3 elements
  const RectangleMesh mesh(body.rectangle, body.elements);
  const CoupledModel model(body, mesh);
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
  const scene::Body body = plainBody();
  const RectangleMesh mesh(body.rectangle, body.elements);
  const CoupledModel model(body, mesh);
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
      EXPECT_EQ(part.prescribed, alone.prescribed);
      EXPECT_EQ(Eigen::MatrixXd(part.stiffness), Eigen::MatrixXd(alone.stiffness));
      EXPECT_EQ(part.load, alone.load);
      EXPECT_EQ(part.kernel, alone.kernel);
      EXPECT_EQ(part.energyOffset, alone.energyOffset);
    }
}

} // namespace
} // namespace epafi::fem
