#include "epafi/fem/BodyModel.hpp"

#include "WholeBody.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

using Value = std::optional<double>;

std::unique_ptr<mesh::Mesh> meshFor(Physics physics) {
  if (physics == Physics::elasticity3d)
    return std::make_unique<mesh::StructuredMesh>(mesh::Box{{1, -1, 0}, {3, 1, 1}},
                                                  std::array<int, 3>{3, 2, 2});
  return std::make_unique<mesh::StructuredMesh>(mesh::rectangle(1, 3, -1, 1), std::array<int, 3>{4, 3, 0});
}

Solid solidOf(Physics physics) {
  Solid solid;
  solid.name = "block";
  solid.physics = physics;
  solid.material = {2.0, 10.0, 0.3, 0.5};
  return solid;
}

int numZeroEigenvalues(const AssembledSubdomain& body) {
  const direct::SymmetricEigen eigen = direct::eigenOf(body.stiffness);
  return static_cast<int>(eigen.numUpTo(1e-9 * eigen.values.maxCoeff()));
}

struct Supported {
  std::string name;
  Physics physics;
  std::vector<SolidSupport> supports;
  int numModes;
};

std::vector<Supported> supportedBodies() {
  const Value free, held = 0.0;
  return {
      {"membrane, free", Physics::membrane, {}, 1},
      {"membrane, held", Physics::membrane, {{"s", "left", {held, free, free}}}, 0},
      {"plane, free", Physics::planeStrain, {}, 3},
      {"plane, one slide", Physics::planeStress, {{"s", "bottom", {free, held, free}}}, 1},
      {"plane, two slides",
       Physics::planeStrain,
       {{"s", "bottom", {free, held, free}}, {"t", "left", {held, free, free}}},
       0},
      {"plane, held", Physics::planeStrain, {{"s", "left", {held, held, free}}}, 0},
      {"space, free", Physics::elasticity3d, {}, 6},
      {"space, one slide", Physics::elasticity3d, {{"s", "bottom", {free, free, held}}}, 3},
      {"space, two slides",
       Physics::elasticity3d,
       {{"s", "bottom", {free, free, held}}, {"t", "left", {held, free, free}}},
       1},
      {"space, held", Physics::elasticity3d, {{"s", "top", {held, held, held}}}, 0},
  };
}

TEST(SolidModelTest, KernelIsExactlyWhatSupportsLeaveFree) {
  for (const Supported& body : supportedBodies()) {
    SCOPED_TRACE(body.name);
    const auto mesh = meshFor(body.physics);
    Solid solid = solidOf(body.physics);
    solid.supports = body.supports;
    const BodyModel model(solid, *mesh);
    EXPECT_EQ(model.kernelDimension(), body.numModes);
    const AssembledSubdomain whole = assembled(model);
    EXPECT_EQ(whole.kernel.cols(), body.numModes);
    EXPECT_LE((whole.stiffness * whole.kernel).norm(), 1e-12 * whole.stiffness.norm());
    EXPECT_EQ(numZeroEigenvalues(whole), body.numModes);
  }
}

/// Sum of the loads' components over all nodes.
Eigen::Vector3d resultant(const BodyModel& model) {
  const AssembledSubdomain whole = assembled(model);
  Eigen::Vector3d sum(0, 0, 0);
  for (std::size_t i = 0; i < whole.unknownPosition.size(); ++i)
    sum[whole.unknownPosition[i] % model.components()] += whole.data.load[i];
  return sum;
}

TEST(SolidModelTest, LoadsAddUpToTheirForces) {
  using Kind = SolidLoad::Kind;
  const auto space = meshFor(Physics::elasticity3d), plane = meshFor(Physics::planeStress);
  Solid solid = solidOf(Physics::elasticity3d), plate = solidOf(Physics::planeStress);
  solid.loads = {{"weight", Kind::body, {}, "", {}, {1, 2, 3}},
                 {"half", Kind::body, {{1, -1, 0}, {3, 0, 1}}, "", {}, {0, 0, 1}},
                 {"pull", Kind::traction, {}, "right", {}, {0, 5, 0}},
                 {"press", Kind::pressure, {}, "top", {}, {7, 0, 0}},
                 {"pin", Kind::point, {}, "", {3, 1, 1}, {0, 0, 11}}};
  // Volume 4, half of it 2, right face 2, top face 4.
  const Eigen::Vector3d expected(4 * 1, 4 * 2 + 2 * 5, 4 * 3 + 2 * 1 - 4 * 7 + 11);
  EXPECT_LE((resultant(BodyModel(solid, *space)) - expected).norm(), 1e-12);

  plate.loads = {{"weight", Kind::body, {}, "", {}, {1, 2, 0}},
                 {"press", Kind::pressure, {}, "left", {}, {3, 0, 0}}};
  // Area 4, left edge 2, thickness 0.5.
  EXPECT_LE((resultant(BodyModel(plate, *plane)) - Eigen::Vector3d(4 * 0.5 + 2 * 3 * 0.5, 4, 0)).norm(),
            1e-12);
}

TEST(SolidModelTest, ABodyThatTurnsIsPulledByItsMassTimesTheDistanceOfItsCentre) {
  using Kind = SolidLoad::Kind;
  const auto space = meshFor(Physics::elasticity3d), plane = meshFor(Physics::planeStress);
  Solid solid = solidOf(Physics::elasticity3d), plate = solidOf(Physics::planeStress);
  const auto centreOf = [](const mesh::Mesh& mesh) { // of boxes the mean of the corners
    Eigen::Vector3d sum(0, 0, 0);
    for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
      for (std::size_t d = 0; d < 3; ++d)
        sum[d] += mesh.point(node)[d] / static_cast<double>(mesh.numNodes());
    return sum;
  };
  solid.loads = {{"turn", Kind::rotation, {}, "", {5, 6, 7}, {3, 0, 0}, true, {0, 3, 4}}};
  const Eigen::Vector3d axis(0, 0.6, 0.8), away = centreOf(*space) - Eigen::Vector3d(5, 6, 7);
  const Eigen::Vector3d expected = 3 * 4 * (away - away.dot(axis) * axis); // the volume is 4
  EXPECT_LE((resultant(BodyModel(solid, *space)) - expected).norm(), 1e-12 * expected.norm());

  plate.loads = {{"turn", Kind::rotation, {}, "", {5, 6, 0}, {3, 0, 0}}};
  const Eigen::Vector3d pull = 3 * 4 * 0.5 * (centreOf(*plane) - Eigen::Vector3d(5, 6, 0));
  EXPECT_LE((resultant(BodyModel(plate, *plane)) - pull).norm(), 1e-12 * pull.norm());
}

TEST(SolidModelTest, RegionsHaveTheirMaterial) {
  const auto mesh = meshFor(Physics::planeStrain);
  Solid solid = solidOf(Physics::planeStrain);
  Material hard = solid.material;
  hard.youngsModulus *= 8;
  solid.regions = {{"right half", {{2, -1, 0}, {3, 1, 0}}, "", hard}};
  const Solid plain = solidOf(Physics::planeStrain);
  const BodyModel model(solid, *mesh), uniform(plain, *mesh);
  for (GlobalOrdinal element = 0; element < mesh->numElements(); ++element) {
    Eigen::MatrixXd k, reference;
    Eigen::VectorXd load;
    model.element(element, k, load);
    uniform.element(element, reference, load);
    const double factor = element % 4 >= 2 ? 8 : 1;
    EXPECT_LE((k - factor * reference).norm(), 1e-13 * k.norm());
    EXPECT_EQ(model.materialOf(element).youngsModulus, factor * 10.0);
  }
}

std::string complaint(const Solid& solid, const mesh::Mesh& mesh) {
  try {
    const BodyModel model(solid, mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SolidModelTest, SaysWhatDoesNotGoTogether) {
  using Kind = SolidLoad::Kind;
  const Value free, held = 0.0, other = 1.0;
  const auto mesh = meshFor(Physics::elasticity3d);
  const auto expectSays = [&](const auto& change, const std::string& words) {
    Solid solid = solidOf(Physics::elasticity3d);
    change(solid);
    const std::string said = complaint(solid, *mesh);
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_NE(said.find("block"), std::string::npos) << said;
  };
  expectSays([&](Solid& s) { s.supports = {{"foot", "sole", {held, free, free}}}; }, "'sole'");
  expectSays([&](Solid& s) { s.regions = {{"inlay", {}, "steel", {}}}; }, "'steel'");
  expectSays([&](Solid& s) { s.regions = {{"inlay", {{8, 8, 8}, {9, 9, 9}}, "", {}}}; }, "inlay");
  expectSays([&](Solid& s) { s.loads = {{"pin", Kind::point, {}, "", {1.1, 0, 0}, {}}}; }, "no node");
  expectSays([&](Solid& s) { s.physics = Physics::planeStrain; }, "hexahedron");
  expectSays([&](Solid& s) { s.reducedIntegration = true; }, "hexahedra of 20 and prisms");
  expectSays(
      [&](Solid& s) {
        s.supports = {{"a", "left", {held, free, free}}, {"b", "top", {other, free, free}}};
      },
      "different values");
}

TEST(SolidModelTest, RefusesPartsThatHangTogetherByANode) {
  mesh::MeshArrays arrays;
  arrays.name = "hinge";
  arrays.cellType = mesh::CellType::triangle;
  arrays.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  arrays.cells = {0, 1, 2, 0, 3, 4};
  arrays.nodeTags = {1, 2, 3, 4, 5};
  arrays.elementTags = {1, 2};
  const mesh::UnstructuredMesh mesh(arrays);
  EXPECT_NE(complaint(solidOf(Physics::planeStrain), mesh).find("mechanism"), std::string::npos);
  EXPECT_EQ(complaint(solidOf(Physics::membrane), mesh), ""); // a membrane cannot turn
}

TEST(SolidModelTest, RefusesPartsThatDoNotHangTogether) {
  mesh::MeshArrays arrays;
  arrays.name = "islands";
  arrays.cellType = mesh::CellType::triangle;
  arrays.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}, {-2, -1, 0}, {-1, -2, 0}};
  arrays.cells = {0, 1, 2, 3, 4, 5};
  arrays.nodeTags = {1, 2, 3, 4, 5, 6};
  arrays.elementTags = {1, 2};
  const mesh::UnstructuredMesh mesh(arrays);
  for (const Physics physics : {Physics::planeStrain, Physics::membrane})
    EXPECT_NE(complaint(solidOf(physics), mesh).find("only 1 of its 2 elements are joined"),
              std::string::npos);
}

} // namespace
} // namespace epafi::fem
