#include "Scenes.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fem/BodyModel.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

using scene::Edge;

TEST(BodyModelTest, AnySupportRemovesTheRigidMode) {
  scene::Body body = plainBody();
  const RectangleMesh mesh(body.rectangle, body.elements);
  EXPECT_EQ(MembraneModel(body, mesh).kernelDimension(), 1);
  body.supports = {{"wall", Edge::bottom, 0.0}};
  EXPECT_EQ(MembraneModel(body, mesh).kernelDimension(), 0);
}

TEST(BodyModelTest, SupportsHoldTheirEdgesAndNothingElse) {
  scene::Body body = plainBody();
  body.supports = {{"wall", Edge::left, 2.5}};
  const RectangleMesh mesh(body.rectangle, body.elements);
  const MembraneModel model(body, mesh);
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    EXPECT_EQ(model.prescribed(node, 0).value_or(-1), mesh.positionOnEdge(Edge::left, node) >= 0 ? 2.5 : -1)
        << node;
}

TEST(BodyModelTest, SupportsThatDisagreeInACornerAreRefusedByName) {
  scene::Body body = plainBody();
  body.supports = {{"wall", Edge::left, 0.0}, {"roof", Edge::top, 1.0}};
  const RectangleMesh mesh(body.rectangle, body.elements);
  try {
    const MembraneModel model(body, mesh);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("wall"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("roof"), std::string::npos) << error.what();
  }
  body.supports = {{"wall", Edge::left, 0.0}, {"other wall", Edge::right, 1.0}};
  EXPECT_NO_THROW(MembraneModel(body, mesh));
  body.supports = {{"wall", Edge::left, 1.0}, {"roof", Edge::top, 1.0}};
  EXPECT_NO_THROW(MembraneModel(body, mesh));
}

TEST(BodyModelTest, TheLastRegionAroundAnElementsCentreHolds) {
  scene::Body body = plainBody();
  body.conductivity = 2;
  body.regions = {{"left half", {0, 1, 0, 1}, 10}, {"corner", {0, 0.6, 0, 0.4}, 100}};
  const RectangleMesh mesh(body.rectangle, body.elements);
  const MembraneModel model(body, mesh);
  Eigen::MatrixXd stiffness, unit;
  Eigen::VectorXd load;
  const auto conductivityOf = [&](GlobalOrdinal element) {
    const scene::Body plain = plainBody();
    MembraneModel(plain, mesh).element(element, unit, load);
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
    body.rectangle = {x, x + 1, 0, 1};
    body.elements = {5, 1};
    body.regions = {{"patch", {x + 0.3, x + 0.7, 0, 1}, 10}};
    const RectangleMesh mesh(body.rectangle, body.elements);
    const MembraneModel model(body, mesh);
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

} // namespace
} // namespace epafi::fem
