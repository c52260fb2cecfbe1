#include "Scenes.hpp"

#include "support/Refusal.hpp"

#include "epafi/fem/BodyModel.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

TEST(BodyModelTest, AnySupportRemovesTheRigidMode) {
  scene::Body body = plainBody();
  const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
  EXPECT_EQ(BodyModel(body, mesh).kernelDimension(), 1);
  body.supports = {{"wall", "bottom", {0.0}}};
  EXPECT_EQ(BodyModel(body, mesh).kernelDimension(), 0);
}

TEST(BodyModelTest, SupportsHoldTheirEdgesAndNothingElse) {
  scene::Body body = plainBody();
  body.supports = {{"wall", "left", {2.5}}};
  const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
  const BodyModel model(body, mesh);
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    EXPECT_EQ(model.prescribed(node, 0).value_or(-1), node % 5 == 0 ? 2.5 : -1) << node;
}

TEST(BodyModelTest, SupportsThatDisagreeInACornerAreRefusedByName) {
  scene::Body body = plainBody();
  body.supports = {{"wall", "left", {0.0}}, {"roof", "top", {1.0}}};
  const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
  epafi::test::expectSays(epafi::test::refusal([&] { BodyModel(body, mesh); }), {"wall", "roof"});
  body.supports = {{"wall", "left", {0.0}}, {"other wall", "right", {1.0}}};
  EXPECT_NO_THROW(BodyModel(body, mesh));
  body.supports = {{"wall", "left", {1.0}}, {"roof", "top", {1.0}}};
  EXPECT_NO_THROW(BodyModel(body, mesh));
}

TEST(BodyModelTest, TheLastRegionAroundAnElementsCentreHolds) {
  scene::Body body = plainBody();
  body.material.conductivity = 2;
  body.regions = {{"left half", mesh::rectangle(0, 1, 0, 1), "", {10}},
                  {"corner", mesh::rectangle(0, 0.6, 0, 0.4), "", {100}}};
  const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
  const BodyModel model(body, mesh);
  Eigen::MatrixXd stiffness, unit;
  Eigen::VectorXd load;
  const auto conductivityOf = [&](GlobalOrdinal element) {
    const scene::Body plain = plainBody();
    BodyModel(plain, mesh).element(element, unit, load);
    model.element(element, stiffness, load);
    return stiffness(0, 0) / unit(0, 0);
  };
  EXPECT_DOUBLE_EQ(conductivityOf(0), 100);
  EXPECT_DOUBLE_EQ(conductivityOf(1), 10);
  EXPECT_DOUBLE_EQ(conductivityOf(4), 10);
  EXPECT_DOUBLE_EQ(conductivityOf(2), 2);
}

TEST(BodyModelTest, AnElementWhoseCentreLiesOnARegionsEdgeBelongsToItWhateverTheRoundOff) {
  for (const double x : {0.0, 1.0, 7.0, 100.0}) { // centres x + 0.1, 0.3, … 0.9, the box ends at x + 0.7
    scene::Body body = plainBody();
    body.mesh.box = mesh::rectangle(x, x + 1, 0, 1);
    body.mesh.elements = {5, 1, 0};
    body.regions = {{"patch", mesh::rectangle(x + 0.3, x + 0.7, 0, 1), "", {10}}};
    const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
    const BodyModel model(body, mesh);
    std::vector<double> conductivity;
    for (GlobalOrdinal element = 0; element < 5; ++element) {
      Eigen::MatrixXd stiffness;
      Eigen::VectorXd load;
      model.element(element, stiffness, load);
      conductivity.push_back(stiffness(0, 0));
    }
    for (const std::size_t inside : {1U, 2U, 3U})
      EXPECT_NEAR(conductivity[inside], 10 * conductivity[0], 1e-9 * conductivity[inside]) << "x = " << x;
    EXPECT_NEAR(conductivity[4], conductivity[0], 1e-9 * conductivity[0]);
  }
}

TEST(BodyModelTest, LoadsAreExactForBoxesThatCutElements) {
  const mesh::Box cut = mesh::rectangle(1.5, 7, -3, 0.5);
  const auto loadOf = [](const mesh::Box& box, bool inSpace) {
    scene::Body body = plainBody();
    body.physics = inSpace ? Physics::elasticity3d : Physics::membrane;
    body.mesh.box = {{1, 0, 0}, {2, 2, 3}};
    body.mesh.elements = {1, 1, inSpace ? 1 : 0};
    body.loads = {fem::loadInside("load", box, 1)};
    const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
    Eigen::MatrixXd loads;
    BodyModel(body, mesh).loads(std::vector<GlobalOrdinal>{0}, loads);
    return Eigen::VectorXd(loads.col(0));
  };
  const Eigen::VectorXd load = loadOf(cut, false);
  ASSERT_EQ(load.size(), 4);
  EXPECT_NEAR(load.sum(), 0.5 * 0.5, 1e-15);                       // area in common
  EXPECT_NEAR(load[1] + load[2], 0.5 * 0.5 * 0.75, 1e-15);         // ∫(x − 1)
  EXPECT_NEAR(load[2] + load[3], 0.5 * 0.5 * 0.25 / 2, 1e-15);     // ∫y/2
  EXPECT_EQ(loadOf(mesh::rectangle(2, 3, 0, 2), false).norm(), 0); // only an edge in common
  EXPECT_LT((loadOf(mesh::rectangle(0, 9, -9, 9), false) - Eigen::Vector4d::Constant(0.5)).norm(), 1e-15);
  EXPECT_LT((loadOf(mesh::Box(), false) - Eigen::Vector4d::Constant(0.5)).norm(), 1e-15);
  const Eigen::VectorXd inSpace = loadOf(cut, true);
  ASSERT_EQ(inSpace.size(), 24);
  for (Eigen::Index node = 0; node < 8; ++node)
    EXPECT_NEAR(inSpace[3 * node], 1.5 * load[node % 4], 1e-15)
        << "half of the height 3 each, below and above";
  EXPECT_NEAR(inSpace.sum(), 0.5 * 0.5 * 3, 1e-14);
}

TEST(BodyModelTest, WholeElementsAreLoadedByTheirCentres) {
  scene::Body body = plainBody(); // columns of width 0.5
  body.loads = {fem::loadInside("load", mesh::rectangle(0.2, 0.8, 0, 1), 6)};
  body.loads[0].wholeElements = true;
  const mesh::StructuredMesh mesh(body.mesh.box, body.mesh.elements);
  Eigen::MatrixXd loads;
  BodyModel(body, mesh).loads(allElements(12), loads);
  for (Eigen::Index element = 0; element < 12; ++element)
    EXPECT_LT((loads.col(element) - Eigen::Vector4d::Constant(element % 4 < 2 ? 0.25 : 0)).norm(), 1e-15)
        << element;
}

} // namespace
} // namespace epafi::fem
