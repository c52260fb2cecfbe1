// Patch tests: a stack of two blocks under pressure has the same stress everywhere, and elements of order 1
// and 2 have its displacement exactly, whatever their shapes, the way the blocks are cut, and the direction
// of the stack.

#include "PatchScenes.hpp"
#include "support/SampleCells.hpp"

#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/MeshTopology.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

namespace epafi {
namespace {

using namespace test;
using epafi::test::MeshFolder;
using epafi::test::Placement;
using mesh::CellType;

constexpr double patchAccuracy = 1e-10;

/// The exact solution in the stack's own coordinates, the last one upwards.
class UniaxialStress {
public:
  UniaxialStress(const Kind& kind, Below below) : kind_(kind), below_(below) {}

  [[nodiscard]] Eigen::Vector3d displacement(int body, const Point& point) const {
    const Placement placement = kind_.placement();
    const int up = kind_.dimension() - 1;
    const double e = 200, nu = 0.3;
    const bool isPlaneStrain = kind_.physics == Physics::planeStrain;
    const double along = -(isPlaneStrain ? 1 - nu * nu : 1) / e,
                 across = nu * (isPlaneStrain ? 1 + nu : 1) / e;
    const Eigen::Vector3d x = placement.turn.transpose() * (epafi::test::vectorOf(point) - placement.shift);
    const double gap = below_ == Below::blockAtADistance && body == 1 ? distance : 0,
                 rest = below_ == Below::plane ? 1 : gap;
    Eigen::Vector3d u = across * pressure * x;
    u[up] = along * pressure * (x[up] - rest) - gap;
    if (up == 1)
      u[2] = 0;
    return placement.turn * u;
  }

  [[nodiscard]] fem::SymmetricTensor stress() const {
    const int up = kind_.dimension() - 1;
    const Eigen::Matrix3d turn = kind_.placement().turn;
    Eigen::Matrix3d s = -pressure * turn.col(up) * turn.col(up).transpose();
    if (kind_.physics == Physics::planeStrain)
      s(2, 2) = -0.3 * pressure;
    return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)};
  }

private:
  Kind kind_;
  Below below_;
};

double largestError(const fem::SymmetricTensor& a, const fem::SymmetricTensor& b) {
  double error = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    error = std::max(error, std::abs(a[k] - b[k]));
  return error;
}

/// Largest error of the displacement of this rank's subdomains, at every copy of a node.
double displacementError(const SolidRun& run, const UniaxialStress& exact) {
  const decomposition::DecomposedProblem& problem = run.decomposition.problem;
  const int n = problem.components;
  double error = 0;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const auto& subdomain = problem.subdomains[s];
    const mesh::Mesh& mesh = *run.decomposition.bodies[subdomain.body].mesh;
    for (std::size_t k = 0; k < subdomain.nodes.size(); ++k) {
      const Eigen::Vector3d expected = exact.displacement(subdomain.body, mesh.point(subdomain.nodes[k]));
      for (int c = 0; c < n; ++c) {
        const double u = run.solution.displacement[s][static_cast<Eigen::Index>(k) * n + c];
        error = std::max(error, std::abs(u - expected[c]));
      }
    }
  }
  return error;
}

/// Largest error of the stress over all elements of a body.
double stressError(const SolidRun& run, const scene::Scene& scene, int body, const UniaxialStress& exact) {
  const mesh::Mesh& mesh = *run.decomposition.bodies[body].mesh;
  const scene::Body& solid = scene.bodies[body];
  const Eigen::VectorXd u = run.displacement(body);
  const int n = run.decomposition.problem.components;
  double error = 0;
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const mesh::ElementNodes nodes(mesh, element);
    std::vector<Point> points;
    std::vector<double> values;
    for (const GlobalOrdinal node : nodes) {
      points.push_back(mesh.point(node));
      for (int c = 0; c < n; ++c)
        values.push_back(u[node * n + c]);
    }
    Eigen::MatrixXd sampled;
    fem::sampledFluxes(nodes.type(), points, solid.physics, solid.material, values, sampled);
    for (const auto& column : sampled.colwise()) {
      fem::SymmetricTensor stress{};
      std::copy(column.begin(), column.end(), stress.begin());
      error = std::max(error, largestError(stress, exact.stress()));
    }
  }
  return error;
}

void expectConstantStress(const scene::Scene& scene, const Kind& kind, Below below) {
  const bool isLinear = kind.order + kind.lowerOrder == 2, isUneven = kind.source == Source::gmsh;
  // uneven elements: larger forces
  const double least = isLinear                            ? 1e-13
                       : isUneven && below == Below::block ? 2e-13
                       : kind.isReduced                    ? 2e-13 // softer
                       : kind.upperElements > 0            ? 1e-12 // ragged parts of a mesh apart
                                                           : 5e-13;
  const SolidRun run(scene, below == Below::tiedBlock ? 2e-12 : least); // round-off allows no less
  const UniaxialStress exact(kind, below);
  EXPECT_EQ(run.solver.report().status, qp::Status::converged) << run.solver.report().reason;
  EXPECT_EQ(run.decomposition.problem.kernelDimension, 1);
  const double area = kind.physics == Physics::axisymmetric ? std::numbers::pi
                      : kind.dimension() == 2               ? 0.5
                                                            : 1;
  EXPECT_LE(displacementError(run, exact), patchAccuracy * pressure / 200);
  for (int body = 0; body < static_cast<int>(scene.bodies.size()); ++body)
    EXPECT_LE(stressError(run, scene, body, exact),
              (below == Below::tiedBlock ? 3 : 1) * patchAccuracy * pressure)
        << body; // tied with the least tolerance that round-off allows
  if (below == Below::tiedBlock)
    return;
  const std::vector<double> forces = run.forces(), &areas = run.decomposition.contacts[0].areas;
  ASSERT_EQ(forces.size(), areas.size());
  ASSERT_GT(forces.size(), 1U);
  const auto without = std::count_if(areas.begin(), areas.end(), [](double a) { return a < 1e-12; });
  EXPECT_LE(without, kind.physics == Physics::axisymmetric ? 1 : 0); // on the axis no force, and no gap
  EXPECT_GE(run.solution.activeContactNodes, std::ssize(forces) - without);
  EXPECT_NEAR(run.solution.contactForce, pressure * area, patchAccuracy * pressure * std::max(1.0, area));
  for (std::size_t row = 0; row < forces.size(); ++row)
    if (areas[row] > 1e-12)
      EXPECT_NEAR(forces[row] / areas[row], pressure, patchAccuracy * pressure) << row;
    else
      EXPECT_NEAR(forces[row], 0, patchAccuracy * pressure) << row;
}

class PatchTest : public testing::TestWithParam<Kind> {};

TEST_P(PatchTest, StressIsConstantHoweverTheBlocksAreCut) {
  const Kind& kind = GetParam();
  const MeshFolder folder;
  scene::Scene scene = stack(kind, Below::block, folder);
  std::vector<scene::Decomposition> cuts;
  if (kind.source == Source::structured && !isSimplex(kind.cell) && kind.lowerElements == 0 &&
      !kind.isSerendipity && kind.cut == Cut::none)
    cuts = {cutInGrid({1, 1, 1}), cutInGrid({2, 3, 1}), cutInGrid({2, 2, kind.dimension() == 3 ? 3 : 1})};
  const bool isTurned =
      kind.placement().shift.norm() > 0; // a few parts have nodes with axes of their own between them
  const bool isCoarse = kind.dimension() == 2 && kind.lowerElements > 0 && kind.lowerElements < 6;
  for (const int parts : isCoarse || kind.upperElements > 0 ? std::vector{2, 5}
                         : isTurned                         ? std::vector{1, 5, 16}
                         : kind.order + kind.lowerOrder > 2 ? std::vector{2, 32}
                                                            : std::vector{1, 2, 3, 5, 8, 16, 32})
    cuts.push_back(cutByMetis(parts));
  for (const scene::Decomposition& cut : cuts) {
    SCOPED_TRACE(testing::Message() << cut.counts[0] << '.' << cut.counts[1] << '.' << cut.counts[2] << ' '
                                    << cut.parts);
    for (scene::Body& body : scene.bodies)
      body.decomposition = cut;
    expectConstantStress(scene, kind, Below::block);
  }
}

TEST_P(PatchTest, StressIsConstantThroughAGapThatClosesOnAPlaneAndThroughATiedJoint) {
  const Kind& kind = GetParam();
  for (const Below below : {Below::blockAtADistance, Below::plane, Below::tiedBlock}) {
    const MeshFolder folder;
    scene::Scene scene = stack(kind, below, folder);
    for (const int parts : {1, kind.upperElements > 0 ? 4 : 7}) {
      SCOPED_TRACE(testing::Message() << parts
                                      << (below == Below::plane       ? " on a plane"
                                          : below == Below::tiedBlock ? " tied"
                                                                      : " after a gap"));
      for (scene::Body& body : scene.bodies)
        body.decomposition = cutByMetis(parts);
      expectConstantStress(scene, kind, below);
    }
  }
}

std::string nameOfKind(const testing::TestParamInfo<Kind>& instance) {
  const Kind& kind = instance.param;
  std::string name =
      toString(kind.physics) + mesh::toString(kind.cell) +
      (kind.source == Source::structured ? "structured"
       : kind.source == Source::turned   ? "turned"
       : kind.source == Source::curved   ? "curved"
                                         : "gmsh") +
      std::to_string(kind.order) +
      (kind.lowerOrder != kind.order ? "on" + std::to_string(kind.lowerOrder) : "") +
      (kind.lowerCell != kind.cell ? std::string("on") + mesh::toString(kind.lowerCell) : "") +
      std::array{"", "", "prisms", "pyramids", "mixed"}.at(static_cast<std::size_t>(kind.cut)) +
      (kind.isSerendipity ? "serendipity" : "") + (kind.isReduced ? "reduced" : "") +
      (kind.upperElements > 0 ? "from" + std::to_string(kind.upperElements) : "") +
      (kind.lowerElements > 0 ? "apart" + std::to_string(kind.lowerElements) : "");
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const Source source : {Source::structured, Source::turned, Source::curved, Source::gmsh})
    for (const auto& [physics, cell] : {std::pair(Physics::planeStrain, CellType::triangle),
                                        {Physics::planeStrain, CellType::quadrilateral},
                                        {Physics::planeStress, CellType::triangle},
                                        {Physics::planeStress, CellType::quadrilateral},
                                        {Physics::elasticity3d, CellType::tetrahedron},
                                        {Physics::elasticity3d, CellType::hexahedron}})
      for (const int order : {1, 2})
        if (order == 2 ? source != Source::turned && physics != Physics::planeStress
                       : source != Source::curved)
          all.push_back({physics, cell, source, order});
  for (const CellType cell : {CellType::quadrilateral, CellType::tetrahedron, CellType::hexahedron})
    for (const int order : {1, 2})
      all.push_back({mesh::dimensionOf(cell) == 2 ? Physics::planeStrain : Physics::elasticity3d, cell,
                     Source::structured, order, 3 - order});
  return all;
}

/// Elements of 8 and 20 nodes; by fewer points straight ones alone pass.
std::vector<Kind> kindsOfSerendipity() {
  std::vector<Kind> all;
  for (const auto& [physics, cell] : {std::pair(Physics::planeStrain, CellType::quadrilateral),
                                      {Physics::elasticity3d, CellType::hexahedron}}) {
    Kind kind{physics, cell, Source::curved, 2};
    kind.isSerendipity = true;
    all.push_back(kind);
    all.push_back(kind);
    all.back().lowerElements = 5; // coupled by mortars
    kind.source = Source::turned;
    kind.isReduced = true;
    all.push_back(kind);
    kind.lowerElements = 3;
    all.push_back(kind);
  }
  return all;
}

/// Prisms, pyramids, and elements of several shapes in each block, by pairs of nodes and by mortars; on the
/// joint of mixed ones squares lie beside triangles.
std::vector<Kind> kindsOfOtherShapes() {
  std::vector<Kind> all;
  for (const Cut cut : {Cut::prisms, Cut::pyramids, Cut::mixed})
    for (const int order : {1, 2})
      for (const int apart : {0, 5}) {
        Kind kind{Physics::elasticity3d, CellType::hexahedron, Source::turned, order};
        kind.cut = cut;
        kind.lowerElements = apart;
        all.push_back(kind);
      }
  for (const Physics physics : {Physics::planeStrain, Physics::axisymmetric})
    for (const int order : {1, 2})
      for (const int apart : {0, 7}) {
        Kind kind{physics, CellType::quadrilateral, Source::structured, order};
        kind.cut = Cut::mixed;
        kind.lowerElements = apart;
        all.push_back(kind);
      }
  Kind pyramids{Physics::elasticity3d, CellType::hexahedron, Source::curved, 2};
  pyramids.cut = Cut::pyramids;
  all.push_back(pyramids);
  return all;
}

/// Cylinders about the y-axis, by pairs of nodes and by mortars.
std::vector<Kind> kindsOfRevolution() {
  using enum CellType;
  std::vector<Kind> all;
  for (const CellType cell : {triangle, quadrilateral})
    for (const int order : {1, 2}) {
      for (const Source source : {Source::structured, Source::gmsh})
        all.push_back({Physics::axisymmetric, cell, source, order});
      for (const int lowerOrder : {1, 2})
        all.push_back({Physics::axisymmetric, cell, Source::structured, order, lowerOrder, quadrilateral, 7});
    }
  Kind kind{Physics::axisymmetric, quadrilateral, Source::structured, 2};
  kind.isSerendipity = true;
  all.push_back(kind);
  kind.isReduced = true;
  all.push_back(kind);
  return all;
}

/// Blocks meshed apart: coupled by mortars.
std::vector<Kind> kindsApart() {
  using enum CellType;
  std::vector<Kind> all;
  for (const auto& [upper, lower] : {std::pair(quadrilateral, quadrilateral),
                                     {triangle, quadrilateral},
                                     {hexahedron, hexahedron},
                                     {hexahedron, tetrahedron},
                                     {tetrahedron, tetrahedron}})
    for (const auto& [order, lowerOrder] : {std::pair(1, 1), {2, 2}, {2, 1}, {1, 2}})
      for (const int elements : {3, 7})
        if (elements == 3 || order + lowerOrder == 2)
          all.push_back({mesh::dimensionOf(upper) == 2 ? Physics::planeStrain : Physics::elasticity3d, upper,
                         Source::structured, order, lowerOrder, lower, elements});
  for (const auto& [upper, lower] : {std::pair(1, 20), {20, 1}, {20, 21}})
    for (const int order : {1, 2})
      all.push_back({Physics::planeStrain, quadrilateral, Source::structured, order, order, quadrilateral,
                     lower, upper});
  for (const CellType cell : {quadrilateral, tetrahedron, hexahedron})
    all.push_back({mesh::dimensionOf(cell) == 2 ? Physics::planeStress : Physics::elasticity3d, cell,
                   Source::turned, 1, 1, cell, 5});
  for (const CellType cell : {triangle, hexahedron, tetrahedron})
    all.push_back({mesh::dimensionOf(cell) == 2 ? Physics::planeStrain : Physics::elasticity3d, cell,
                   Source::curved, 2, 2, cell, 5});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Stacks, PatchTest, testing::ValuesIn(kinds()), nameOfKind);
INSTANTIATE_TEST_SUITE_P(Serendipity, PatchTest, testing::ValuesIn(kindsOfSerendipity()), nameOfKind);
INSTANTIATE_TEST_SUITE_P(OtherShapes, PatchTest, testing::ValuesIn(kindsOfOtherShapes()), nameOfKind);
INSTANTIATE_TEST_SUITE_P(OfRevolution, PatchTest, testing::ValuesIn(kindsOfRevolution()), nameOfKind);
INSTANTIATE_TEST_SUITE_P(Apart, PatchTest, testing::ValuesIn(kindsApart()), nameOfKind);

} // namespace
} // namespace epafi
