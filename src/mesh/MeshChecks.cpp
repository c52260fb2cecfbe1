#include "epafi/mesh/MeshChecks.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/HangingNodes.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace epafi::mesh {
namespace {

/// Measures and Jacobians below this, in powers of the element's diameter, are none.
constexpr double shapeTolerance = 1e-10;
/// Nodes nearer than this, in diameters of the body, are at the same place.
constexpr double placeTolerance = 1e-10;

/// What to do about elements that are too large for what they lie in.
const std::string finer =
    "mesh with smaller elements (of a .geo file by its sizes or a \"Mesh Size Factor\" below 1)";

/// The checks of one mesh; what they say of nodes and elements is in the file's numbers.
class Checker {
public:
  Checker(const MeshArrays& mesh, const MeshTopology& topology)
      : mesh_(mesh), topology_(topology), dimension_(dimensionOf(mesh.cellType)),
        facet_(dimension_ == 2 ? "edge" : "face") {}

  void checkNodes() const;
  void checkPoints();
  void checkShapes() const;
  void checkPlaces(const BoxTree& tree) const;
  void checkSharing() const;
  void checkHangingNodes(const BoxTree& tree) const;

private:
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(mesh_.name + ": " + what); }
  [[nodiscard]] std::string element(LocalOrdinal number) const {
    return std::string("element ") + std::to_string(mesh_.elementTags[index(number)]);
  }
  [[nodiscard]] std::string node(std::size_t number) const {
    const GlobalOrdinal tag = mesh_.nodeTags[number];
    return tag < 0 ? "an added node" : "node " + std::to_string(tag);
  }
  /// "(0.5, 1)"
  [[nodiscard]] std::string place(std::size_t number) const;
  [[nodiscard]] ElementShape shape(LocalOrdinal number) const;
  [[nodiscard]] std::span<const LocalOrdinal> nodes(LocalOrdinal number) const {
    return nodesOf(mesh_.cellType, mesh_.cells, number);
  }
  [[nodiscard]] bool haveSameNodes(LocalOrdinal a, LocalOrdinal b) const;
  [[noreturn]] void refuseShape(LocalOrdinal first, const ElementShape& bad) const;
  [[noreturn]] void refuseCopies(LocalOrdinal a, LocalOrdinal b) const;

  const MeshArrays& mesh_;
  const MeshTopology& topology_;
  int dimension_;
  std::string facet_;
  double size_ = 0; ///< diagonal of the body's box
};

std::string Checker::place(std::size_t number) const {
  return text(std::span(mesh_.points[number]).first(dimension_));
}

ElementShape Checker::shape(LocalOrdinal number) const {
  std::array<Point, mostNodes> corners{};
  const auto places = nodes(number);
  for (std::size_t i = 0; i < places.size(); ++i)
    corners[i] = mesh_.points[index(places[i])];
  return shapeOf(cellOf(mesh_.cellType, places.size()),
                 std::span<const Point>(corners.data(), places.size()));
}

bool Checker::haveSameNodes(LocalOrdinal a, LocalOrdinal b) const {
  return std::is_permutation(nodes(a).begin(), nodes(a).end(), nodes(b).begin(), nodes(b).end());
}

void Checker::checkNodes() const {
  for (LocalOrdinal e = 0; e < mesh_.numElements(); ++e) {
    auto own = nodes(e);
    if (const CellType type = cellOf(mesh_.cellType, own.size()); type == mesh_.cellType)
      own = rowOf(type, mesh_.cells, index(e));
    for (auto next = own.begin(); next != own.end(); ++next)
      if (std::find(own.begin(), next, *next) != next)
        refuse(element(e) + " has " + node(*next) + " twice; give it " +
               std::to_string(numNodesOf(mesh_.cellType)) + " different nodes");
  }
  for (std::size_t n = 0; n < mesh_.points.size(); ++n)
    if (topology_.elementsOf(n).empty())
      refuse(node(n) + " at " + place(n) +
             " is listed with the body but belongs to none of its elements; remove it from the file, or mesh "
             "anew");
}

void Checker::checkPoints() {
  for (std::size_t n = 0; n < mesh_.points.size(); ++n)
    for (const double value : mesh_.points[n])
      if (!std::isfinite(value))
        refuse(node(n) + " has a coordinate that is not a finite number; mesh anew");
  const auto [lower, upper] = boxOf(mesh_.points);
  size_ = std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
  if (dimension_ == 3)
    return;
  for (std::size_t n = 0; n < mesh_.points.size(); ++n)
    if (std::abs(mesh_.points[n][2]) > placeTolerance * size_)
      refuse(node(n) + " lies at z = " + text(mesh_.points[n][2]) + ", but a body of " +
             toString(mesh_.cellType) +
             "s lies in the plane z = 0; move it there, or, if the body is solid, mesh its volume (gmsh -3)");
}

void Checker::checkShapes() const {
  LocalOrdinal first = -1;
  ElementShape bad;
  LocalOrdinal others = 0, numSound = 0; // inverted as well, and not
  for (LocalOrdinal e = 0; e < mesh_.numElements(); ++e) {
    const ElementShape own = shape(e);
    const double none = shapeTolerance * std::pow(own.diameter, dimension_);
    if (own.leastJacobian > none) {
      ++numSound;
      continue;
    }
    if (first < 0) {
      first = e;
      bad = own;
      if (own.measure >= -none)
        break;
    } else if (own.measure < -none) {
      ++others;
    }
  }
  if (first < 0)
    return;
  const double none = shapeTolerance * std::pow(bad.diameter, dimension_);
  if (bad.measure >= -none)
    refuseShape(first, bad);
  const std::string more = others == 0   ? " is"
                           : others == 1 ? " and another one are"
                                         : " and " + std::to_string(others) + " others are";
  const std::string renumber =
      dimension_ == 2
          ? "number nodes counter-clockwise, in a .geo file by turning the curve loop of the surface round"
          : "number the nodes of these elements the other way round, as Gmsh does, or mesh anew";
  refuse(element(first) + more + " inverted (" + (dimension_ == 2 ? "area " : "volume ") + text(bad.measure) +
         ") near " + place(nodes(first)[0]) + "; " +
         (numSound > 0 ? "where the mesh is too coarse for a thin wall, " + finer + "; else " : "") +
         renumber);
}

void Checker::refuseShape(LocalOrdinal first, const ElementShape& bad) const {
  if (bad.measure <= shapeTolerance * std::pow(bad.diameter, dimension_))
    refuse(element(first) + " near " + place(nodes(first)[0]) + " is flat: its " +
           (dimension_ == 2 ? "area" : "volume") + " is 0; move its nodes, or mesh anew");
  refuse(element(first) + " is folded " +
         (bad.corner < 0 ? std::string("inside") : "at " + node(nodes(first)[index(bad.corner)])) +
         ": its Jacobian is not positive there; move its nodes, or, where the mesh is too coarse for the "
         "shape, " +
         finer);
}

void Checker::checkPlaces(const BoxTree& tree) const {
  const double tolerance = placeTolerance * size_;
  std::vector<std::size_t> found;
  for (const Point& point : mesh_.points) {
    tree.meeting(boxOf(std::span(&point, 1), tolerance), found);
    if (found.size() < 2)
      continue;
    const std::size_t first = found[0], second = found[1];
    refuse(
        node(first) + " and " + node(second) + " are both at " + place(first) +
        ", so that the body is cut there; merge them (in a .geo file \"Coherence Mesh;\" after meshing). If "
        "the cut "
        "is meant, as where parts or a crack's lips meet, make a body of each side, by physical groups, and "
        "tie them where they hold together");
  }
}

void Checker::refuseCopies(LocalOrdinal a, LocalOrdinal b) const {
  refuse(element(a) + " and " + element(b) + " have the same nodes; list an element once");
}

void Checker::checkSharing() const {
  if (topology_.crowdedFacet()) {
    const auto [a, b, c] = *topology_.crowdedFacet();
    if (haveSameNodes(a, b))
      refuseCopies(a, b);
    if (haveSameNodes(b, c))
      refuseCopies(b, c);
    if (haveSameNodes(a, c))
      refuseCopies(a, c);
    refuse("the elements " + std::to_string(mesh_.elementTags[index(a)]) + ", " +
           std::to_string(mesh_.elementTags[index(b)]) + " and " +
           std::to_string(mesh_.elementTags[index(c)]) + " share one " + facet_ +
           ", which two elements at most can do; remove those that overlap others");
  }
  const std::size_t perElement = facetsOf(mesh_.cellType).size();
  for (LocalOrdinal e = 0; e < mesh_.numElements(); ++e)
    for (std::size_t f = 0; f < perElement; ++f)
      for (std::size_t g = 0; g < f; ++g) {
        const LocalOrdinal other = topology_.across(e, f);
        if (other < 0 || topology_.across(e, g) != other)
          continue;
        if (haveSameNodes(e, other))
          refuseCopies(e, other);
        refuse(element(e) + " and " + element(other) + " share more than one " + facet_ +
               ", so that they overlap; mesh anew");
      }
  if (orderOf(mesh_.cellType) == 1)
    return;
  for (LocalOrdinal e = 0; e < mesh_.numElements(); ++e)
    for (std::size_t f = 0; f < perElement; ++f) {
      const LocalOrdinal other = topology_.across(e, f);
      if (other < 0)
        continue;
      const auto own = nodes(e), others = nodes(other);
      for (const int place : facetsOf(cellOf(mesh_.cellType, own.size()))[f])
        if (const LocalOrdinal shared = own[index(place)];
            std::find(others.begin(), others.end(), shared) == others.end())
          refuse(element(e) + " and " + element(other) + " share the corners of one " + facet_ +
                 ", but not " + node(shared) + " between them, so that the body is cut there; mesh anew");
    }
}

void Checker::checkHangingNodes(const BoxTree& tree) const {
  if (const auto hanging = findHangingNode(mesh_, topology_, tree))
    refuse(
        node(hanging->node) + " at " + place(hanging->node) + " lies on the boundary of " +
        element(hanging->element) +
        " without belonging to it (a hanging node). If these are parts of an assembly, as those of a STEP "
        "file, "
        "make a body of each, by physical groups, and tie them or let them touch; parts of one body should "
        "share all their nodes there, in a .geo file by \"Coherence;\" or BooleanFragments before meshing");
}

} // namespace

void checkMesh(const MeshArrays& mesh, const MeshTopology& topology) {
  if (mesh.numElements() == 0)
    throw InputError(mesh.name + " has no elements; mesh it first");
  Checker checker(mesh, topology);
  checker.checkNodes();
  checker.checkPoints();
  checker.checkShapes();
  const BoxTree tree(mesh.points);
  checker.checkPlaces(tree);
  checker.checkSharing();
  checker.checkHangingNodes(tree);
}

} // namespace epafi::mesh
