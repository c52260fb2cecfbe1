#include "PatchScenes.hpp"

#include "support/SampleCells.hpp"

#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/MeshTopology.hpp"

#include <array>
#include <utility>

namespace epafi::test {

using epafi::test::MeshFolder;
using epafi::test::Placement;
using mesh::CellType;

bool isSimplex(CellType cell) {
  return cell == CellType::triangle || cell == CellType::tetrahedron;
}

namespace {

/// Both blocks in one geometry; the nodes of the joint fit, and belong to one block each.
std::string geometryOf(CellType cell, double gap) {
  const std::string top = std::to_string(1 + gap), up = std::to_string(gap);
  if (mesh::dimensionOf(cell) == 2)
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
mesh::MeshArrays curved(mesh::MeshArrays arrays, mesh::InnerNodes inner) {
  arrays = completed(std::move(arrays), false, inner);
  for (std::size_t node = 0; node < arrays.nodeTags.size(); ++node)
    arrays.nodeTags[node] = static_cast<GlobalOrdinal>(node) + 1;
  const mesh::MeshTopology topology(arrays.cellType, static_cast<LocalOrdinal>(arrays.points.size()),
                                    arrays.cells);
  test::SignedRandomNumbers random(7);
  for (std::size_t node = 0; node < arrays.points.size(); ++node)
    for (int d = 0;
         d < dimensionOf(arrays.cellType) && !topology.isOnBoundary(static_cast<LocalOrdinal>(node)); ++d)
      arrays.points[node][d] += 0.01 * random();
  return arrays;
}

/// The mesh of a block in [0, 1]ⁿ, lifted by `bottom`.
meshing::MeshSource meshOf(const Kind& kind, bool isLower, double bottom, const MeshFolder& folder) {
  const bool isSpace = kind.dimension() == 3;
  const int order = isLower ? kind.lowerOrder : kind.order;
  const CellType cell = isLower ? kind.lowerCell : kind.cell;
  meshing::MeshSource source;
  source.box =
      isSpace ? mesh::Box{{0, 0, bottom}, {1, 1, bottom + 1}} : mesh::Box{{0, bottom, 0}, {1, bottom + 1, 0}};
  source.elements = isSpace ? std::array{4, 4, 3} : std::array{6, 6, 0};
  if (const int along = isLower ? kind.lowerElements : kind.upperElements; along > 0)
    source.elements[0] = along;
  if (isLower && kind.lowerElements > 0 && isSpace)
    source.elements[1] = kind.lowerElements + 1;
  source.order = order;
  if (kind.source == Source::structured && !isSimplex(cell) && !kind.isSerendipity && kind.cut == Cut::none)
    return source;
  const auto inner = kind.isSerendipity ? mesh::InnerNodes::none : mesh::InnerNodes::added;
  const mesh::StructuredMesh mesh(source.box, source.elements);
  mesh::MeshArrays arrays = arraysOf(mesh, kind.placement(), isSimplex(cell) ? Cut::simplices : kind.cut);
  if (kind.source == Source::curved)
    arrays = curved(std::move(arrays), inner);
  meshing::MeshSource file;
  file.file = folder.write(isLower ? "lower.msh" : "upper.msh", epafi::test::fileOf(arrays));
  file.group = "body";
  file.order = kind.source == Source::curved ? 0 : order;
  file.innerNodes = inner;
  return file;
}

} // namespace

scene::Scene stack(const Kind& kind, Below below, const MeshFolder& folder) {
  const double gap = below == Below::blockAtADistance ? distance : 0;
  scene::Scene scene;
  for (int level = 0; level < 2; ++level) {
    scene::Body body;
    body.name = level == 0 ? "lower" : "upper";
    body.physics = kind.physics;
    body.material = {1.0, 200.0, 0.3, 0.5};
    body.reducedIntegration = kind.isReduced;
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
  scene.bodies[1].loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {0, 0, 0}, {pressure, 0, 0}}};
  scene.contacts = {between("joint", 0, "top", 1, "bottom")};
  if (below == Below::tiedBlock)
    scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
  if (below == Below::plane) {
    scene.bodies.erase(scene.bodies.begin());
    const Placement placement = kind.placement();
    const Eigen::Vector3d up = placement.turn.col(kind.dimension() - 1),
                          point = placement.of(kind.dimension() == 3 ? Point{0, 0, 1} : Point{0, 1, 0});
    scene.contacts = {onPlane("joint", 0, "bottom", {point[0], point[1], point[2]}, {up[0], up[1], up[2]})};
  }
  return scene;
}

} // namespace epafi::test
