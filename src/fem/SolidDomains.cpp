#include "epafi/fem/SolidDomains.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/MeshPart.hpp"

#include <algorithm>

namespace epafi::fem {
namespace {

/// Whether a point lies in a box, its faces included.
bool liesIn(const Point& point, const mesh::Box& box, int dimension) {
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
    if (!(box.lower[d] <= point[d] && point[d] <= box.upper[d]))
      return false;
  return true;
}

/// The columns, rows or layers whose middle lies in [low, high], the ends and round-off included: the first
/// one, and the one after the last.
std::array<GlobalOrdinal, 2> rangeIn(const mesh::StructuredMesh& mesh, std::size_t axis, double low,
                                     double high) {
  const double roundOff = 1e-9 * mesh.elementSize()[axis];
  const auto middle = [&](GlobalOrdinal k) {
    return 0.5 * (mesh.coordinate(axis, k) + mesh.coordinate(axis, k + 1));
  };
  GlobalOrdinal first = 0, end = mesh.elements()[axis];
  while (first < end && middle(first) < low - roundOff)
    ++first;
  while (end > first && middle(end - 1) > high + roundOff)
    --end;
  return {first, end};
}

} // namespace

SolidDomain::SolidDomain(const SolidBody& body, const std::string& user, const std::string& group,
                         const mesh::Box& box, bool mayBeEmpty)
    : isGroup_(!group.empty()), box_(box) {
  if (isGroup_) {
    elements_ = body.groupOf(user, group);
    return;
  }
  bool isEmpty = false;
  if (const mesh::StructuredMesh* mesh = body.mesh.structured()) {
    for (std::size_t d = 0; d < 3; ++d) {
      ranges_[d] = mesh->dimension() == 2 && d == 2 ? std::array<GlobalOrdinal, 2>{0, 1}
                                                    : rangeIn(*mesh, d, box.lower[d], box.upper[d]);
      isEmpty = isEmpty || ranges_[d][0] == ranges_[d][1];
    }
  } else if (const mesh::MeshPart* part = body.mesh.part()) {
    isEmpty = std::none_of(part->elements().begin(), part->elements().end(),
                           [&](GlobalOrdinal element) { return contains(body, element); });
  } else {
    GlobalOrdinal element = 0;
    while (element < body.mesh.numElements() && !contains(body, element))
      ++element;
    isEmpty = element == body.mesh.numElements();
  }
  if (!mayBeEmpty)
    body.require(!isEmpty, user + ": no element has its centre in its box");
}

bool SolidDomain::contains(const SolidBody& body, GlobalOrdinal element) const {
  if (isGroup_)
    return std::binary_search(elements_.begin(), elements_.end(), element);
  std::vector<Point> points;
  body.mesh.elementPoints(element, points);
  const mesh::CellType type = cellOf(body.mesh.cellType(), points.size());
  const auto corners = std::span(points).first(numCornersOf(type));
  return liesIn(mesh::centreOf(corners), box_, dimensionOf(type));
}

SolidRegions::SolidRegions(const SolidBody& body) {
  for (const SolidRegion& region : body.solid.regions)
    domains_.emplace_back(body, "region '" + region.name + "'", region.group, region.box, region.mayBeEmpty);
}

void SolidRegions::of(const SolidBody& body, std::span<const GlobalOrdinal> elements,
                      std::span<GlobalOrdinal> regions) const {
  std::fill(regions.begin(), regions.end(), GlobalOrdinal{0});
  for (std::size_t r = 0; r < domains_.size(); ++r)
    domains_[r].forEachIn(body, elements, [&](std::size_t e) { regions[e] = r + 1; });
}

std::size_t SolidRegions::of(const SolidBody& body, GlobalOrdinal element) const {
  GlobalOrdinal region = 0;
  of(body, std::span(&element, 1), std::span(&region, 1));
  return region;
}

const Material& materialIn(const Solid& body, std::size_t region) {
  return region == 0 ? body.material : body.regions[region - 1].material;
}

} // namespace epafi::fem
