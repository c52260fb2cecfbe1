#include "epafi/fem/BoxMesh.hpp"

#include "epafi/fem/GridWalk.hpp"

#include <algorithm>
#include <string_view>

namespace epafi::fem {
namespace {

using Place = std::array<GlobalOrdinal, 3>;

/// A face of the box and the facet of an element that lies on it.
struct Face {
  std::string_view name;
  std::size_t axis = 0; ///< that it is normal to
  bool isFar = false;
  std::size_t facet = 0; ///< among facetsOf(hexahedron)
};

constexpr std::array<Face, 6> allFaces{{{"left", 0, false, 5},
                                        {"right", 0, true, 3},
                                        {"front", 1, false, 2},
                                        {"back", 1, true, 4},
                                        {"bottom", 2, false, 0},
                                        {"top", 2, true, 1}}};

/// (i,j,k) of a number.
Place placeOf(GlobalOrdinal number, GlobalOrdinal rowLength, GlobalOrdinal rowsPerLayer) {
  const GlobalOrdinal row = number / rowLength, k = row / rowsPerLayer;
  return {number - row * rowLength, row - k * rowsPerLayer, k};
}

/// Of the n elements in a row, how many touch its node i.
int numTouching(GlobalOrdinal i, int n) {
  return (i > 0 ? 1 : 0) + (i < n ? 1 : 0);
}

/// Appends the elements from (i,j,k) = first to end, the latter excluded, ascending.
void appendElements(const Place& first, const Place& end, const std::array<int, 3>& size,
                    std::vector<GlobalOrdinal>& elements) {
  for (GlobalOrdinal k = first[2]; k < end[2]; ++k)
    for (GlobalOrdinal j = first[1]; j < end[1]; ++j)
      for (GlobalOrdinal i = first[0]; i < end[0]; ++i)
        elements.push_back(i + size[0] * (j + size[1] * k));
}

} // namespace

BoxMesh::BoxMesh(const scene::Box& box, std::array<int, 3> elements) : box_(box), elements_(elements) {}

GlobalOrdinal BoxMesh::numNodes() const {
  return static_cast<GlobalOrdinal>(elements_[0] + 1) * (elements_[1] + 1) * (elements_[2] + 1);
}

GlobalOrdinal BoxMesh::numElements() const {
  return static_cast<GlobalOrdinal>(elements_[0]) * elements_[1] * elements_[2];
}

Point BoxMesh::point(GlobalOrdinal node) const {
  const Place place = placeOf(node, elements_[0] + 1, elements_[1] + 1);
  Point point{};
  for (std::size_t d = 0; d < 3; ++d) {
    // Interpolated from both ends, so that the last node lies on the far face to the last digit.
    const double t = static_cast<double>(place[d]) / elements_[d];
    point[d] = (1 - t) * box_.lower[d] + t * box_.upper[d];
  }
  return point;
}

void BoxMesh::elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const {
  elementNodes(std::span(&element, 1), nodes);
}

void BoxMesh::elementNodes(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> nodes) const {
  const GlobalOrdinal row = elements_[0] + 1, layer = row * (elements_[1] + 1);
  const std::array<GlobalOrdinal, 8> offsets{0,     1,         row + 1,         row,
                                             layer, layer + 1, layer + row + 1, layer + row};
  BoxWalk walk(elements_[0], elements_[1]);
  auto next = nodes.begin();
  for (const GlobalOrdinal element : elements) {
    walk.to(element);
    const GlobalOrdinal lowest = walk.column() + walk.row() * row + walk.layer() * layer;
    next = std::transform(offsets.begin(), offsets.end(), next,
                          [lowest](GlobalOrdinal offset) { return lowest + offset; });
  }
}

void BoxMesh::nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  const Place place = placeOf(node, elements_[0] + 1, elements_[1] + 1);
  Place first{}, end{};
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = std::max<GlobalOrdinal>(place[d] - 1, 0);
    end[d] = std::min<GlobalOrdinal>(place[d] + 1, elements_[d]);
  }
  appendElements(first, end, elements_, elements);
}

void BoxMesh::numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const {
  BoxWalk walk(elements_[0] + 1, elements_[1] + 1);
  auto number = numbers.begin();
  for (const GlobalOrdinal node : nodes) {
    walk.to(node);
    *number++ = numTouching(walk.column(), elements_[0]) * numTouching(walk.row(), elements_[1]) *
                numTouching(walk.layer(), elements_[2]);
  }
}

void BoxMesh::elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const {
  elements.clear();
  const Place place = placeOf(element, elements_[0], elements_[1]);
  const Place step{1, elements_[0], static_cast<GlobalOrdinal>(elements_[0]) * elements_[1]};
  for (std::size_t d = 3; d-- > 0;)
    if (place[d] > 0)
      elements.push_back(element - step[d]);
  for (std::size_t d = 0; d < 3; ++d)
    if (place[d] + 1 < elements_[d])
      elements.push_back(element + step[d]);
}

bool BoxMesh::isBoundaryNode(GlobalOrdinal node) const {
  const Place place = placeOf(node, elements_[0] + 1, elements_[1] + 1);
  for (std::size_t d = 0; d < 3; ++d)
    if (place[d] == 0 || place[d] == elements_[d])
      return true;
  return false;
}

std::vector<std::string> BoxMesh::surfaceNames() const {
  std::vector<std::string> names;
  for (const Face& face : allFaces)
    names.emplace_back(face.name);
  return names;
}

Surface BoxMesh::surface(const std::string& name) const {
  const Face& face =
      *std::find_if(allFaces.begin(), allFaces.end(), [&](const Face& f) { return f.name == name; });
  Place first{0, 0, 0}, end{elements_[0], elements_[1], elements_[2]};
  if (face.isFar)
    first[face.axis] = end[face.axis] - 1;
  else
    end[face.axis] = 1;
  Surface surface;
  appendElements(first, end, elements_, surface.elements);

  const std::array<int, 4>& facet = facetsOf(cellType())[face.facet];
  surface.nodesPerFacet = 4;
  surface.facetNodes.reserve(4 * surface.elements.size());
  std::array<GlobalOrdinal, 8> corners{};
  for (const GlobalOrdinal element : surface.elements) {
    elementNodes(element, corners);
    for (const int corner : facet)
      surface.facetNodes.push_back(corners[static_cast<std::size_t>(corner)]);
  }
  return surface;
}

std::vector<GlobalOrdinal> BoxMesh::group(const std::string& /*name*/) const {
  return {};
}

scene::Vector3 BoxMesh::elementSize() const {
  scene::Vector3 size{};
  for (std::size_t d = 0; d < 3; ++d)
    size[d] = (box_.upper[d] - box_.lower[d]) / elements_[d];
  return size;
}

scene::Box BoxMesh::elementBox(GlobalOrdinal element) const {
  std::array<GlobalOrdinal, 8> nodes{};
  elementNodes(element, nodes);
  return {point(nodes[0]), point(nodes[6])};
}

} // namespace epafi::fem
