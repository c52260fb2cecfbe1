#include "epafi/contact/ContactPlaces.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <optional>

namespace epafi::contact {
namespace {

using decomposition::ContactPlace;
using Eigen::Vector3d;

/// What a row takes of one side.
class Share {
public:
  explicit Share(const SmoothSide& side) : side_(side) {}

  void add(const NodeShare& share) {
    const Point x = (*side_.pointAt)(share.node);
    place_ += share.weight * Vector3d(x[0], x[1], x[2]);
    if (const auto& normal = side_.surface->at(share.node)) {
      normal_ += share.weight * normal->direction; // linear in the place on cylinders and spheres
      uncertainty_ += std::abs(share.weight) * normal->uncertainty;
    } else {
      hasEdge_ = true;
    }
  }
  [[nodiscard]] const Vector3d& place() const { return place_; }
  [[nodiscard]] std::optional<UncertainNormal> normal() const {
    if (hasEdge_ || !(normal_.norm() > 0))
      return std::nullopt;
    return UncertainNormal{normal_.normalized(), uncertainty_};
  }

private:
  SmoothSide side_;
  Vector3d place_{0, 0, 0}, normal_{0, 0, 0};
  double uncertainty_ = 0;
  bool hasEdge_ = false;
};

} // namespace

decomposition::ContactPlace placeOf(const ContactLayout& contact, std::size_t row, const SmoothSide& first,
                                    const SmoothSide& second) {
  const Vector3d direction = contact.directionAt(row);
  Share mine(first), theirs(second);
  contact.forEachFirst(row, [&](const NodeShare& share) { mine.add(share); });
  for (const NodeShare& share : contact.secondNodes[row])
    theirs.add(share);
  const std::optional<UncertainNormal> here = mine.normal();
  std::optional<UncertainNormal> there = theirs.normal();
  if (there)
    there->direction *= -1;
  ContactPlace place{contact.firstRow + static_cast<GlobalOrdinal>(row),
                     {contact.firstBody, mine.place(), direction, 0},
                     {contact.secondBody, theirs.place(), direction, 0}};
  const auto know = [](ContactPlace::Side& side, const std::optional<UncertainNormal>& known) {
    if (known) {
      side.normal = known->direction;
      side.uncertainty = known->uncertainty;
    }
  };
  know(place.first, here ? here : there);
  know(place.second, there ? there : here);
  return place;
}

} // namespace epafi::contact
