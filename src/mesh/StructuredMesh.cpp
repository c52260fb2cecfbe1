#include "epafi/mesh/StructuredMesh.hpp"

#include "epafi/mesh/ShapeFunctions.hpp"

#include <algorithm>
#include <string_view>

namespace epafi::mesh {
namespace {

using GridPlace = std::array<GlobalOrdinal, 3>;

/// A side of the box and the facet of an element that lies on it.
struct Side {
  std::string_view name;
  std::size_t axis = 0; ///< that it is normal to
  bool isFar = false;
  std::size_t facet = 0; ///< among facetsOf() the cells
};

constexpr std::array<Side, 4> sidesOfRectangle{
    {{"left", 0, false, 3}, {"right", 0, true, 1}, {"bottom", 1, false, 0}, {"top", 1, true, 2}}};
constexpr std::array<Side, 6> sidesOfBox{{{"left", 0, false, 5},
                                          {"right", 0, true, 3},
                                          {"front", 1, false, 2},
                                          {"back", 1, true, 4},
                                          {"bottom", 2, false, 0},
                                          {"top", 2, true, 1}}};

std::span<const Side> sidesOf(int dimension) {
  return dimension == 2 ? std::span<const Side>(sidesOfRectangle) : std::span<const Side>(sidesOfBox);
}

/// (i,j,k) of the nodes of an element in the order of Cell.hpp: of order 1, then of order 2.
template <int dim>
std::array<std::vector<std::array<int, 3>>, 2> placesIn() {
  std::array<std::vector<std::array<int, 3>>, 2> all;
  const CellType linear = dim == 2 ? CellType::quadrilateral : CellType::hexahedron;
  for (int order = 1; order <= 2; ++order) {
    const Shape<dim>& shape = referenceShape<dim>(withOrder(linear, order));
    for (int node = 0; node < shape.numNodes; ++node) {
      std::array<int, 3>& place = all[order - 1].emplace_back();
      for (int d = 0; d < dim; ++d)
        place[d] = static_cast<int>(shape.node(node)[d] + 1) * order / 2;
    }
  }
  return all;
}

/// (i,j,k) of a number.
GridPlace placeOf(GlobalOrdinal number, const std::array<int, 3>& size) {
  GridWalk walk(size[0], size[1]);
  walk.to(number);
  return walk.place();
}

/// Of the n elements of an order in a row, how many touch its node i.
int numTouching(GlobalOrdinal i, int n, int order) {
  return order == 2 && i % 2 != 0 ? 1 : 2 - (i == 0) - (i == GlobalOrdinal{n} * order);
}

/// Appends the elements from (i,j,k) = first to end, the latter excluded, ascending.
void appendElements(const GridPlace& first, const GridPlace& end, const std::array<int, 3>& size,
                    std::vector<GlobalOrdinal>& elements) {
  for (GlobalOrdinal k = first[2]; k < end[2]; ++k)
    for (GlobalOrdinal j = first[1]; j < end[1]; ++j)
      for (GlobalOrdinal i = first[0]; i < end[0]; ++i)
        elements.push_back(i + size[0] * (j + size[1] * k));
}

} // namespace

StructuredMesh::StructuredMesh(const Box& box, const std::array<int, 3>& elements, int order)
    : box_(box), dimension_(elements[2] > 0 ? 3 : 2),
      order_(order), elements_{elements[0], elements[1], std::max(elements[2], 1)},
      nodes_{order * elements[0] + 1, order * elements[1] + 1, order * elements[2] + 1} {
  if (dimension_ == 2)
    box_.lower[2] = box_.upper[2] = 0;
  for (std::size_t d = 0; d < 3; ++d)
    elementSize_[d] = (box_.upper[d] - box_.lower[d]) / elements_[d];
}

GlobalOrdinal StructuredMesh::numNodes() const {
  return GlobalOrdinal{nodes_[0]} * nodes_[1] * nodes_[2];
}

GlobalOrdinal StructuredMesh::numElements() const {
  return GlobalOrdinal{elements_[0]} * elements_[1] * elements_[2];
}

double StructuredMesh::nodeCoordinate(std::size_t axis, GlobalOrdinal k) const {
  // Interpolated from both ends, so that the last node lies on the far side to the last digit.
  const double t = static_cast<double>(k) / (order_ * elements_[axis]);
  return (1 - t) * box_.lower[axis] + t * box_.upper[axis];
}

Point StructuredMesh::point(GlobalOrdinal node) const {
  const GridPlace place = placeOf(node, nodes_);
  return {nodeCoordinate(0, place[0]), nodeCoordinate(1, place[1]), nodeCoordinate(2, place[2])};
}

void StructuredMesh::elementNodes(std::span<const GlobalOrdinal> elements,
                                  std::span<GlobalOrdinal> nodes) const {
  const GlobalOrdinal row = nodes_[0], layer = row * nodes_[1];
  std::array<GlobalOrdinal, mostNodes> offsets{};
  const std::size_t perElement = places().size();
  for (std::size_t i = 0; i < perElement; ++i)
    offsets[i] = places()[i][0] + places()[i][1] * row + places()[i][2] * layer;
  GridWalk walk = elementWalk();
  GlobalOrdinal* next = nodes.data();
  for (const GlobalOrdinal element : elements) {
    walk.to(element);
    const GlobalOrdinal lowest = order_ * (walk[0] + walk[1] * row + walk[2] * layer);
    for (std::size_t i = 0; i < perElement; ++i)
      *next++ = lowest + offsets[i];
  }
}

void StructuredMesh::nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  const GridPlace place = placeOf(node, nodes_);
  GridPlace first{}, end{};
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = std::max<GlobalOrdinal>((place[d] + order_ - 1) / order_ - 1, 0);
    end[d] = std::min<GlobalOrdinal>(place[d] / order_ + 1, elements_[d]);
  }
  appendElements(first, end, elements_, elements);
}

void StructuredMesh::numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const {
  GridWalk walk(nodes_[0], nodes_[1]);
  for (std::size_t k = 0; k < nodes.size();) { // row by row
    walk.to(nodes[k]);
    const GlobalOrdinal first = nodes[k] - walk[0];
    const int ofRow = numTouching(walk[1], elements_[1], order_) * numTouching(walk[2], elements_[2], order_);
    for (; k < nodes.size() && nodes[k] < first + nodes_[0]; ++k)
      numbers[k] = ofRow * numTouching(nodes[k] - first, elements_[0], order_);
  }
}

void StructuredMesh::elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  const GridPlace place = placeOf(element, elements_);
  const GridPlace step{1, elements_[0], GlobalOrdinal{elements_[0]} * elements_[1]};
  for (std::size_t d = 3; d-- > 0;)
    if (place[d] > 0)
      elements.push_back(element - step[d]);
  for (std::size_t d = 0; d < 3; ++d)
    if (place[d] + 1 < elements_[d])
      elements.push_back(element + step[d]);
}

bool StructuredMesh::isBoundaryNode(GlobalOrdinal node) const {
  const GridPlace place = placeOf(node, nodes_);
  for (int d = 0; d < dimension_; ++d)
    if (place[d] == 0 || place[d] == nodes_[d] - 1)
      return true;
  return false;
}

std::vector<std::string> StructuredMesh::surfaceNames() const {
  std::vector<std::string> names;
  for (const Side& side : sidesOf(dimension_))
    names.emplace_back(side.name);
  return names;
}

Surface StructuredMesh::surface(const std::string& name) const {
  if (name.empty())
    return elementsAsSurface();
  const auto sides = sidesOf(dimension_);
  const Side& side = *std::find_if(sides.begin(), sides.end(), [&](const Side& s) { return s.name == name; });
  GridPlace first{0, 0, 0}, end{elements_[0], elements_[1], elements_[2]};
  if (side.isFar)
    first[side.axis] = end[side.axis] - 1;
  else
    end[side.axis] = 1;
  Surface surface{facetTypeOf(cellType()), {}, {}};
  appendElements(first, end, elements_, surface.elements);
  const Facet& facet = facetsOf(cellType())[side.facet];
  surface.facetNodes.reserve(facet.size() * surface.elements.size());
  for (const GlobalOrdinal element : surface.elements) {
    const ElementNodes nodes(*this, element);
    for (const int corner : facet)
      surface.facetNodes.push_back(nodes[corner]);
  }
  return surface;
}

std::vector<Point> StructuredMesh::elementShape() const {
  std::vector<Point> points;
  for (const auto& [i, j, k] : places())
    points.push_back(
        {i * elementSize_[0] / order_, j * elementSize_[1] / order_, k * elementSize_[2] / order_});
  return points;
}

std::span<const std::array<int, 3>> StructuredMesh::places() const {
  static const auto ofPlane = placesIn<2>(), ofSpace = placesIn<3>();
  return (dimension_ == 2 ? ofPlane : ofSpace)[order_ - 1];
}

std::vector<Point> congruentShape(const Mesh& mesh) {
  return mesh.structured() != nullptr ? mesh.structured()->elementShape() : std::vector<Point>();
}

} // namespace epafi::mesh
