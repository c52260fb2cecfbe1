#include "epafi/fem/SolidDomains.hpp"

#include "epafi/fem/ElementGeometry.hpp"

#include <algorithm>

namespace epafi::fem {
namespace {

/// Whether a point lies in a box, its faces included.
bool liesIn(const Point& point, const scene::Box& box, int dimension) {
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
    if (!(box.lower[d] <= point[d] && point[d] <= box.upper[d]))
      return false;
  return true;
}

} // namespace

SolidDomain::SolidDomain(const SolidBody& body, const std::string& user, const std::string& group,
                         const scene::Box& box)
    : isGroup_(!group.empty()), box_(box) {
  if (isGroup_) {
    elements_ = body.groupOf(user, group);
    return;
  }
  for (GlobalOrdinal element = 0; element < body.mesh.numElements(); ++element)
    if (contains(body, element))
      return;
  throw body.refusal(user + ": no element has its centre in its box");
}

bool SolidDomain::contains(const SolidBody& body, GlobalOrdinal element) const {
  if (isGroup_)
    return std::binary_search(elements_.begin(), elements_.end(), element);
  std::vector<Point> points;
  body.pointsOf(element, points);
  return liesIn(centreOf(points), box_, dimensionOf(body.mesh.cellType()));
}

SolidRegions::SolidRegions(const SolidBody& body) {
  for (const scene::SolidRegion& region : body.solid.regions)
    domains_.emplace_back(body, "region '" + region.name + "'", region.group, region.box);
}

std::size_t SolidRegions::regionOf(const SolidBody& body, GlobalOrdinal element) const {
  for (std::size_t r = domains_.size(); r > 0; --r)
    if (domains_[r - 1].contains(body, element))
      return r;
  return 0;
}

const scene::Material& materialIn(const scene::Solid& solid, std::size_t region) {
  return region == 0 ? solid.material : solid.regions[region - 1].material;
}

} // namespace epafi::fem
