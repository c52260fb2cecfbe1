#include "epafi/scene/MeshReader.hpp"

#include "epafi/base/ParameterValue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace epafi::scene {
namespace {

std::string text(const std::array<int, 3>& counts) {
  return '{' + std::to_string(counts[0]) + ", " + std::to_string(counts[1]) +
         (counts[2] > 0 ? ", " + std::to_string(counts[2]) : "") + '}';
}

/// Nodes are counted by int, and their coordinates must be told apart by a double with digits to spare.
void requireTellableNodes(const ListReader& list, const std::string& extent, const meshing::MeshSource& mesh,
                          std::size_t dimension) {
  constexpr double mostNodes = std::numeric_limits<int>::max();
  double numNodes = 1;
  for (std::size_t d = 0; d < dimension; ++d)
    numNodes *= 1.0 * mesh.order * mesh.elements[d] + 1;
  if (numNodes > mostNodes)
    list.refuseValue("Elements", "that makes " + valueText(numNodes) + " nodes and a body may have at most " +
                                     valueText(mostNodes));
  constexpr double relativeWidth = 1e-12;
  for (std::size_t d = 0; d < dimension; ++d) {
    const double lower = mesh.box.lower[d], upper = mesh.box.upper[d];
    if ((upper - lower) / mesh.elements[d] <= relativeWidth * std::max(std::abs(lower), std::abs(upper)))
      list.refuseValue(extent, "elements of its size over " + text(mesh.elements) +
                                   " are too thin at that distance from the origin to be told apart");
  }
}

meshing::MeshSource readMeshFile(const ListReader& list) {
  meshing::MeshSource source;
  list.refuseGiven({"Rectangle", "Box", "Elements"}, "the body has a mesh file; remove one of them");
  source.file = list.file("Mesh");
  source.sizeFactor = list.positive("Mesh Size Factor");
  if (!meshing::isGeometry(source.file))
    list.refuseGiven({"Mesh Size Factor"},
                     "only a geometry (.geo, .step) is meshed in a size of your choice");
  source.stepSizes = {list.integer("Elements Around"), list.reals("Fine Points")};
  for (std::size_t i = 3; i < source.stepSizes.finePoints.size(); i += 4)
    if (!(source.stepSizes.finePoints[i] > 0))
      list.refuseValue("Fine Points", "sizes, each fourth number, must be positive");
  if (source.stepSizes.finePoints.size() % 4 != 0)
    list.refuseValue("Fine Points", "must have four numbers a point, {x, y, z, size, ...}");
  if (!meshing::isStep(source.file))
    list.refuseGiven({"Elements Around", "Fine Points"}, "it is for STEP files; a .geo says its own sizes");
  source.refinements = list.integer("Mesh Refinements");
  if (meshing::isSplit(source.file)) {
    if (!source.file.ends_with(".msh"))
      list.refuseValue(
          "Mesh", "several files hold a mesh by parts only as Gmsh saves it, so the name must end in .msh");
    if (source.file.find('*') != source.file.rfind('*'))
      list.refuseValue("Mesh", "there may be one * in it, which stands for the number of a file");
    list.refuseGiven({"Mesh Refinements"}, "a mesh in several files is read as it is; refine it in Gmsh");
  }
  source.group = list.word("Group");
  if (list.word("Inner Nodes") == "none")
    source.innerNodes = mesh::InnerNodes::none;
  source.order = list.has("Order") || meshing::isGeometry(source.file) ? list.integer("Order") : 0;
  return source;
}

} // namespace

meshing::MeshSource readMesh(const ListReader& list, int dimension) {
  if (list.hasEntries("Mesh"))
    return readMeshFile(list);
  meshing::MeshSource source;
  list.refuseGiven(
      {"Group", "Mesh Size Factor", "Elements Around", "Fine Points", "Mesh Refinements", "Inner Nodes"},
      "the body has no mesh file that it could apply to");
  list.refuseGiven({dimension == 3 ? "Rectangle" : "Box"},
                   "a body in " +
                       std::string(dimension == 3 ? "space has a \"Box\"" : "the plane has a \"Rectangle\""));
  const std::string extent = dimension == 3 ? "Box" : "Rectangle";
  for (const std::string& name : {extent, std::string("Elements")})
    list.require(name, " unless it has a mesh file");
  source.box = list.box(extent, dimension);
  source.elements = list.counts("Elements", dimension);
  source.order = list.integer("Order");
  if (dimension == 2)
    source.elements[2] = 0;
  requireTellableNodes(list, extent, source, dimension);
  return source;
}

Decomposition readDecomposition(const ListReader& list, const std::string& body,
                                const meshing::MeshSource& mesh, int dimension) {
  Decomposition cut;
  cut.cluster = list.integer("Cluster");
  const std::array<int, 3>& elements = mesh.elements;
  const bool isStructured = mesh.file.empty();
  const std::string tooMany = "body \"" + body + "\" has only " + text(elements) + " elements";
  if (list.word("Method") == "grid" && (isStructured || list.has("Method"))) {
    if (!isStructured)
      list.refuseValue("Method", "body \"" + body + "\" has a mesh file; cut it by \"metis\"");
    cut.method = Decomposition::Method::grid;
    const bool isGiven = list.has("Grid");
    if (isGiven)
      cut.counts = list.counts("Grid", dimension);
    for (std::size_t d = 0; d < 3; ++d) {
      const int most = std::max(elements[d], 1);
      if (isGiven && cut.counts[d] > most)
        list.refuseValue("Grid", tooMany);
      cut.counts[d] = std::min(cut.counts[d], most);
    }
  } else {
    cut.method = Decomposition::Method::metis;
    cut.parts = list.integer("Parts");
    if (isStructured &&
        cut.parts > static_cast<long long>(elements[0]) * elements[1] * std::max(elements[2], 1))
      list.refuseValue("Parts", tooMany);
  }
  return cut;
}

} // namespace epafi::scene
