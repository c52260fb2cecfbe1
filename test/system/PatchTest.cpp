// Patch tests: a stack of two blocks under pressure has the same stress everywhere, and elements of order 1 and 2 have its
// displacement exactly, whatever their shapes, the way the blocks are cut, and the direction of the stack.

#include "../fem/MeshFiles.hpp"
#include "../fem/SampleCells.hpp"
#include "../fem/TurnedMesh.hpp"
#include "SolidScenes.hpp"

#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/fem/MeshOrder.hpp"
#include "epafi/fem/MeshTopology.hpp"

#include <array>
#include <vector>

namespace epafi {
namespace {

using namespace test;
using fem::CellType;
using fem::test::MeshFolder;
using fem::test::Placement;

constexpr double pressure = 3, accuracy = 1e-10;

/// Where the elements come from: the program's own boxes (of simplices: the same in a file), a file of them turned and
/// moved away, the same of curved elements of order 2, or a geometry that Gmsh meshes as it likes but for the joint.
enum class Source { structured, turned, curved, gmsh };

struct Kind {
  Physics physics;
  CellType cell;
  Source source;
  int order = 1;
  int lowerOrder = order;    ///< of the lower block
  CellType lowerCell = cell; ///< likewise
  int lowerElements = 0;     ///< along the joint, if the lower block is meshed apart
  int upperElements = 0;     ///< along the joint, if not as usual

  [[nodiscard]] int dimension() const { return fem::dimensionOf(cell); }
  [[nodiscard]] Placement placement() const {
    return source == Source::turned || source == Source::curved
               ? fem::test::placed(dimension(), 0.7, {2, -1, dimension() == 3 ? 3.0 : 0.0})
               : Placement{};
  }
};

bool isSimplex(CellType cell) {
  return cell == CellType::triangle || cell == CellType::tetrahedron;
}

/// What the upper block is pressed against.
enum class Below { block, tiedBlock, blockAtADistance, plane };

constexpr double distance = 0.01;

/// Both blocks in one geometry; the nodes of the joint fit, and belong to one block each.
std::string geometryOf(CellType cell, double gap) {
  const std::string top = std::to_string(1 + gap), up = std::to_string(gap);
  if (fem::dimensionOf(cell) == 2)
    return R"(SetFactory("OpenCASCADE");
Mesh.CharacteristicLengthMax = 0.2;
Rectangle(1) = {0, 0, 0, 1, 1};
Rectangle(2) = {0, )" +
           top + R"(, 0, 1, 1};
)" + (cell == CellType::quadrilateral ? "Recombine Surface {1, 2}; Mesh.SubdivisionAlgorithm = 1;\n" : "") +
           R"(Physical Surface("lower") = {1}; Physical Surface("upper") = {2};
Physical Curve("bottom") = {1, 5}; Physical Curve("top") = {3, 7}; Physical Curve("left") = {4, 8};
)";
  if (cell == CellType::tetrahedron)
    return R"(SetFactory("OpenCASCADE");
Mesh.CharacteristicLengthMax = 0.4;
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {0, 0, )" +
           top + R"(, 1, 1, 1};
Periodic Surface {11} = {6} Translate {0, 0, )" +
           up + R"(};
Physical Volume("lower") = {1}; Physical Volume("upper") = {2};
Physical Surface("bottom") = {5, 11}; Physical Surface("top") = {6, 12};
Physical Surface("left") = {1, 7}; Physical Surface("front") = {3, 9};
)";
  return R"(SetFactory("OpenCASCADE");
Mesh.CharacteristicLengthMax = 0.5; Mesh.SubdivisionAlgorithm = 1;
Rectangle(1) = {0, 0, 0, 1, 1};
Rectangle(2) = {0, 0, )" +
         top + R"(, 1, 1};
Recombine Surface {1, 2};
lower() = Extrude {0, 0, 1} { Surface{1}; Layers{{1, 2}, {0.4, 1}}; Recombine; };
upper() = Extrude {0, 0, 1} { Surface{2}; Layers{3}; Recombine; };
Physical Volume("lower") = {lower(1)}; Physical Volume("upper") = {upper(1)};
Physical Surface("bottom") = {1, 2}; Physical Surface("top") = {lower(0), upper(0)};
Physical Surface("front") = {lower(2), upper(2)}; Physical Surface("left") = {lower(5), upper(5)};
)";
}

/// Of order 2, the nodes inside moved about: all edges inside are curved.
fem::MeshArrays curved(fem::MeshArrays arrays) {
  arrays = completed(std::move(arrays), false);
  for (std::size_t node = 0; node < arrays.nodeTags.size(); ++node)
    arrays.nodeTags[node] = static_cast<GlobalOrdinal>(node) + 1;
  const fem::MeshTopology topology(arrays.cellType, static_cast<LocalOrdinal>(arrays.points.size()),
                                   arrays.cells);
  fem::RandomNumbers random(7);
  for (std::size_t node = 0; node < arrays.points.size(); ++node)
    for (int d = 0;
         d < dimensionOf(arrays.cellType) && !topology.isOnBoundary(static_cast<LocalOrdinal>(node)); ++d)
      arrays.points[node][static_cast<std::size_t>(d)] += 0.01 * random();
  return arrays;
}

/// The mesh of a block in [0, 1]ⁿ, lifted by `bottom`.
scene::MeshSource meshOf(const Kind& kind, bool isLower, double bottom, const MeshFolder& folder) {
  const bool isSpace = kind.dimension() == 3;
  const int order = isLower ? kind.lowerOrder : kind.order;
  const CellType cell = isLower ? kind.lowerCell : kind.cell;
  scene::MeshSource source;
  source.box = isSpace ? scene::Box{{0, 0, bottom}, {1, 1, bottom + 1}}
                       : scene::Box{{0, bottom, 0}, {1, bottom + 1, 0}};
  source.elements = isSpace ? std::array{4, 4, 3} : std::array{6, 6, 0};
  if (const int along = isLower ? kind.lowerElements : kind.upperElements; along > 0)
    source.elements[0] = along;
  if (isLower && kind.lowerElements > 0 && isSpace)
    source.elements[1] = kind.lowerElements + 1;
  source.order = order;
  if (kind.source == Source::structured && !isSimplex(cell))
    return source;
  const fem::StructuredMesh mesh(source.box, source.elements);
  fem::MeshArrays arrays = arraysOf(mesh, kind.placement(), isSimplex(cell));
  if (kind.source == Source::curved)
    arrays = curved(std::move(arrays));
  scene::MeshSource file;
  file.file = folder.write(isLower ? "lower.msh" : "upper.msh", fem::test::fileOf(arrays));
  file.group = "body";
  file.order = kind.source == Source::curved ? 0 : order;
  return file;
}

/// Two blocks, one on the other, on a sliding floor, or the upper one alone on a plane in the lower one's place; the upper
/// one floats and is pressed down.
scene::Scene stack(const Kind& kind, Below below, const MeshFolder& folder) {
  const double gap = below == Below::blockAtADistance ? distance : 0;
  scene::Scene scene;
  for (int level = 0; level < 2; ++level) {
    scene::Body body;
    body.name = level == 0 ? "lower" : "upper";
    body.physics = kind.physics;
    body.material = {1.0, 200.0, 0.3, 0.5};
    if (kind.source == Source::gmsh) {
      body.mesh.file =
          level == 0 ? folder.write("stack.geo", geometryOf(kind.cell, gap)) : folder.path("stack.geo");
      body.mesh.group = body.name;
      body.mesh.order = kind.order;
    } else
      body.mesh = meshOf(kind, level == 0, level == 0 ? 0 : 1 + gap, folder);
    body.supports = {slide("left")};
    if (kind.dimension() == 3)
      body.supports.push_back(slide("front"));
    scene.bodies.push_back(body);
  }
  scene.bodies[0].supports.push_back(slide("bottom"));
  scene.bodies[1].loads = {
      {"press", scene::SolidLoad::Kind::pressure, {}, "top", {0, 0, 0}, {pressure, 0, 0}}};
  scene.contacts = {between("joint", 0, "top", 1, "bottom")};
  if (below == Below::tiedBlock)
    scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
  if (below == Below::plane) {
    scene.bodies.erase(scene.bodies.begin());
    const Placement placement = kind.placement();
    const Eigen::Vector3d up = placement.turn.col(kind.dimension() - 1),
                          point =
                              placement.of(kind.dimension() == 3 ? fem::Point{0, 0, 1} : fem::Point{0, 1, 0});
    scene.contacts = {onPlane("joint", 0, "bottom", {point[0], point[1], point[2]}, {up[0], up[1], up[2]})};
  }
  return scene;
}

/// The exact solution in the stack's own coordinates, the last one upwards.
class UniaxialStress {
public:
  UniaxialStress(const Kind& kind, Below below) : kind_(kind), below_(below) {}

  [[nodiscard]] Eigen::Vector3d displacement(int body, const fem::Point& point) const {
    const Placement placement = kind_.placement();
    const int up = kind_.dimension() - 1;
    const double e = 200, nu = 0.3;
    const bool isPlaneStrain = kind_.physics == Physics::planeStrain;
    const double along = -(isPlaneStrain ? 1 - nu * nu : 1) / e,
                 across = nu * (isPlaneStrain ? 1 + nu : 1) / e;
    const Eigen::Vector3d x = placement.turn.transpose() * (fem::test::vectorOf(point) - placement.shift);
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
    const fem::Mesh& mesh = *run.decomposition.bodies[static_cast<std::size_t>(subdomain.body)].mesh;
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
  const fem::Mesh& mesh = *run.decomposition.bodies[static_cast<std::size_t>(body)].mesh;
  const scene::Body& solid = scene.bodies[static_cast<std::size_t>(body)];
  const Eigen::VectorXd u = run.displacement(body);
  const int n = run.decomposition.problem.components;
  std::vector<GlobalOrdinal> nodes(static_cast<std::size_t>(mesh.nodesPerElement()));
  double error = 0;
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    mesh.elementNodes(element, nodes);
    std::vector<fem::Point> points;
    std::vector<double> values;
    for (const GlobalOrdinal node : nodes) {
      points.push_back(mesh.point(node));
      for (int c = 0; c < n; ++c)
        values.push_back(u[node * n + c]);
    }
    Eigen::MatrixXd sampled;
    fem::sampledFluxes(mesh.cellType(), points, solid.physics, solid.material, values, sampled);
    for (const auto& column : sampled.colwise()) {
      fem::SymmetricTensor stress{};
      std::copy(column.begin(), column.end(), stress.begin());
      error = std::max(error, largestError(stress, exact.stress()));
    }
  }
  return error;
}

void expectConstantStress(const scene::Scene& scene, const Kind& kind, Below below) {
  const bool isLinear = kind.order + kind.lowerOrder == 2;
  const SolidRun run(scene, below == Below::tiedBlock           ? 2e-12 // round-off allows no less
                            : below == Below::block || isLinear ? 1e-13
                                                                : 5e-13);
  const UniaxialStress exact(kind, below);
  EXPECT_EQ(run.solver.report().status, qp::Status::converged) << run.solver.report().reason;
  EXPECT_EQ(run.decomposition.problem.kernelDimension, 1);
  const double thickness = kind.dimension() == 2 ? 0.5 : 1;
  EXPECT_LE(displacementError(run, exact), accuracy * pressure / 200);
  for (int body = 0; body < static_cast<int>(scene.bodies.size()); ++body)
    EXPECT_LE(stressError(run, scene, body, exact), (below == Below::tiedBlock ? 3 : 1) * accuracy * pressure)
        << body; // tied with the least tolerance that round-off allows
  if (below == Below::tiedBlock)
    return;
  const std::vector<double> forces = run.forces(), &areas = run.decomposition.contacts[0].areas;
  ASSERT_EQ(forces.size(), areas.size());
  ASSERT_GT(forces.size(), 1U);
  EXPECT_EQ(run.solution.activeContactNodes, static_cast<GlobalOrdinal>(forces.size()));
  EXPECT_NEAR(run.solution.contactForce, pressure * thickness, accuracy * pressure);
  for (std::size_t row = 0; row < forces.size(); ++row)
    EXPECT_NEAR(forces[row] / (areas[row] * thickness), pressure, accuracy * pressure) << row;
}

class PatchTest : public testing::TestWithParam<Kind> {};

TEST_P(PatchTest, StressIsConstantHoweverTheBlocksAreCut) {
  const Kind& kind = GetParam();
  const MeshFolder folder;
  scene::Scene scene = stack(kind, Below::block, folder);
  std::vector<scene::Decomposition> cuts;
  if (kind.source == Source::structured && !isSimplex(kind.cell) && kind.lowerElements == 0)
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

std::string nameOf(const testing::TestParamInfo<Kind>& instance) {
  const Kind& kind = instance.param;
  std::string name = toString(kind.physics) + fem::toString(kind.cell) +
                     (kind.source == Source::structured ? "structured"
                      : kind.source == Source::turned   ? "turned"
                      : kind.source == Source::curved   ? "curved"
                                                        : "gmsh") +
                     std::to_string(kind.order) +
                     (kind.lowerOrder != kind.order ? "on" + std::to_string(kind.lowerOrder) : "") +
                     (kind.lowerCell != kind.cell ? std::string("on") + fem::toString(kind.lowerCell) : "") +
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
      all.push_back({fem::dimensionOf(cell) == 2 ? Physics::planeStrain : Physics::elasticity3d, cell,
                     Source::structured, order, 3 - order});
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
          all.push_back({fem::dimensionOf(upper) == 2 ? Physics::planeStrain : Physics::elasticity3d, upper,
                         Source::structured, order, lowerOrder, lower, elements});
  for (const auto& [upper, lower] : {std::pair(1, 20), {20, 1}, {20, 21}})
    for (const int order : {1, 2})
      all.push_back({Physics::planeStrain, quadrilateral, Source::structured, order, order, quadrilateral,
                     lower, upper});
  for (const CellType cell : {quadrilateral, tetrahedron, hexahedron})
    all.push_back({fem::dimensionOf(cell) == 2 ? Physics::planeStress : Physics::elasticity3d, cell,
                   Source::turned, 1, 1, cell, 5});
  for (const CellType cell : {triangle, hexahedron, tetrahedron})
    all.push_back({fem::dimensionOf(cell) == 2 ? Physics::planeStrain : Physics::elasticity3d, cell,
                   Source::curved, 2, 2, cell, 5});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Stacks, PatchTest, testing::ValuesIn(kinds()), nameOf);
INSTANTIATE_TEST_SUITE_P(Apart, PatchTest, testing::ValuesIn(kindsApart()), nameOf);

} // namespace
} // namespace epafi
