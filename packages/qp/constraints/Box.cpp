#include "epafi/qp/constraints/Box.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Tpetra_Map.hpp>

#include <cmath>
#include <sstream>
#include <utility>

namespace epafi::qp {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

Box::Box(RCP<const Vector> lower, RCP<const Vector> upper)
    : lower_(std::move(lower)), upper_(std::move(upper)) {}

Box::Box(RCP<const Vector> lower, RCP<const Vector> upper, std::vector<Growth> growth)
    : lower_(std::move(lower)), upper_(std::move(upper)), growth_(std::move(growth)) {}

Box::Local::Local(const Box& box) {
  if (!box.lower_.is_null())
    lower_ = localData(*box.lower_).data();
  if (!box.upper_.is_null())
    upper_ = localData(*box.upper_).data();
}

std::string Box::emptiness(const Map& map) const {
  std::string found;
  collectively(*map.getComm(), [&] {
    for (const RCP<const Vector>& bound : {lower_, upper_})
      if (!bound.is_null() && !bound->getMap()->isCompatible(map))
        throw InputError("the bounds are not on the map of the unknowns; give them as vectors on the domain "
                         "map of the Hessian");
  });
  collectively(*map.getComm(), [&] {
    const Local bounds = local();
    const std::size_t size =
        lower_.is_null() && upper_.is_null() ? 0 : (lower_.is_null() ? upper_ : lower_)->getLocalLength();
    for (std::size_t i = 0; i < size; ++i) {
      const Interval interval = bounds[i];
      std::ostringstream where;
      where << "entry " << map.getGlobalElement(static_cast<LocalOrdinal>(i)) << ": lower " << interval.lower
            << ", upper " << interval.upper;
      if (std::isnan(interval.lower) || std::isnan(interval.upper))
        throw InputError("a bound is not a number, " + where.str() + "; use infinity for 'no bound'");
      if (found.empty() &&
          (interval.lower > interval.upper || interval.lower == infinity || interval.upper == -infinity))
        found = "the bounds leave no value for " + where.str();
    }
  });
  return agreedText(*map.getComm(), found);
}

void Box::project(Vector& x) const {
  const Local bounds = local();
  const std::span<double> values = localDataNonConst(x);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = bounds[i].project(values[i]);
}

void Box::move(double length, const Vector& p, Vector& x) const {
  const Local bounds = local();
  const auto direction = localData(p);
  const auto values = localDataNonConst(x);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = bounds[i].project(values[i] - length * direction[i]);
}

double Box::maxFeasibleStep(const Vector& x, const Vector& p) const {
  const Local bounds = local();
  const auto values = localData(x), direction = localData(p);
  double longest = infinity;
  for (std::size_t i = 0; i < values.size(); ++i)
    longest = std::min(longest, bounds[i].maxFeasibleStep(values[i], direction[i]));
  return longest;
}

GradientSums Box::measure(const Vector& x, const Vector& g, const Vector& image, double step) const {
  const Local bounds = local();
  const auto values = localData(x), gradient = localData(g), w = localData(image);
  GradientSums sums;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Interval interval = bounds[i];
    sums.solutionSquared.add(values[i] * values[i]);
    if (interval.isFree(values[i])) {
      const double free = gradient[i];
      sums.freeSquared.add(free * free);
      sums.reducedTimesFree.add(free * interval.reducedFreeGradient(values[i], free, step));
      sums.freeTimesImage.add(free * w[i]);
    } else {
      const double chopped = interval.choppedGradient(values[i], gradient[i]);
      sums.choppedSquared.add(chopped * chopped);
      ++sums.active;
    }
  }
  return sums;
}

void Box::subtractFromFreeGradient(const Vector& x, const Vector& g, double factor, Vector& y) const {
  const Local bounds = local();
  const auto values = localData(x), gradient = localData(g);
  const auto result = localDataNonConst(y);
  for (std::size_t i = 0; i < values.size(); ++i)
    result[i] = bounds[i].freeGradient(values[i], gradient[i]) - (factor != 0 ? factor * result[i] : 0.0);
}

void Box::choppedGradient(const Vector& x, const Vector& g, double negligible, Vector& y) const {
  const Local bounds = local();
  const auto values = localData(x), gradient = localData(g);
  const auto result = localDataNonConst(y);
  for (std::size_t i = 0; i < values.size(); ++i)
    result[i] = bounds[i].choppedGradient(values[i], gradient[i], negligible);
}

void Box::projectedGradient(const Vector& x, const Vector& g, double negligible, Vector& y) const {
  const Local bounds = local();
  const auto values = localData(x), gradient = localData(g);
  const auto result = localDataNonConst(y);
  for (std::size_t i = 0; i < values.size(); ++i)
    result[i] = bounds[i].isFree(values[i]) ? gradient[i]
                                            : bounds[i].choppedGradient(values[i], gradient[i], negligible);
}

void Box::restrictToFree(const Vector& x, Vector& z) const {
  const Local bounds = local();
  const auto values = localData(x);
  const auto result = localDataNonConst(z);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!bounds[i].isFree(values[i]))
      result[i] = 0;
}

void Box::restrictToReleased(const Vector& x, const Vector& g, double negligible, Vector& z) const {
  const Local bounds = local();
  const auto values = localData(x), gradient = localData(g);
  const auto result = localDataNonConst(z);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Interval interval = bounds[i];
    // At a lower bound β and an inward z are negative, at an upper one positive.
    if (!interval.isFree(values[i]) &&
        !(interval.choppedGradient(values[i], gradient[i], negligible) * result[i] > 0))
      result[i] = 0;
  }
}

void Box::freeIndicator(const Vector& x, Vector& y) const {
  const Local bounds = local();
  const auto values = localData(x);
  const auto result = localDataNonConst(y);
  for (std::size_t i = 0; i < values.size(); ++i)
    result[i] = bounds[i].isFree(values[i]) ? 1.0 : 0.0;
}

void Box::fixedIndicator(Vector& y) const {
  const Local bounds = local();
  const auto result = localDataNonConst(y);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = bounds[i].lower < bounds[i].upper ? 0 : 1;
}

void Box::distanceToBoundary(const Vector& x, double atMost, Vector& y) const {
  const Local bounds = local();
  const auto values = localData(x);
  const auto result = localDataNonConst(y);
  for (std::size_t i = 0; i < values.size(); ++i)
    result[i] = std::max(0.0, std::min({values[i] - bounds[i].lower, bounds[i].upper - values[i], atMost}));
}

void Box::activate(const Vector& active, Vector& x) const {
  const Local bounds = local();
  const auto chosen = localData(active);
  const auto values = localDataNonConst(x);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (chosen[i] == 0)
      continue;
    const Interval interval = bounds[i];
    const double below = std::abs(values[i] - interval.lower), above = std::abs(values[i] - interval.upper);
    const bool isMiddle = // no side is nearer
        std::isfinite(below + above) && std::abs(below - above) <= 1e-9 * (below + above);
    const double nearer = below <= above ? interval.lower : interval.upper;
    if (std::isfinite(nearer) && !isMiddle)
      values[i] = nearer;
  }
}

double Box::complementarity(const Vector& x, const Vector& g, double scale) const {
  const Local bounds = local();
  const auto values = localData(x), gradient = localData(g);
  double largest = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double room = gradient[i] > 0 ? values[i] - bounds[i].lower : bounds[i].upper - values[i];
    largest = std::max(largest, std::min(std::abs(gradient[i]), scale * room));
  }
  return largest;
}

double Box::longestMultiplierStep(const Vector& x, const Vector& g, const Vector& s) const {
  const Local bounds = local();
  const auto values = localData(x), gradient = localData(g), shift = localData(s);
  double longest = infinity;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Interval interval = bounds[i];
    if (shift[i] == 0 || !(interval.lower < interval.upper))
      continue;
    if (interval.isFree(values[i]))
      return 0;
    if ((values[i] <= interval.lower) == (shift[i] < 0)) // the multiplier moves towards 0
      longest = std::min(longest, -gradient[i] / shift[i]);
  }
  return longest;
}

void Box::followBoundary(const Vector& x, const Vector& /*g*/, double /*least*/, const Face* /*from*/,
                         Face& face) const {
  face.followers.clear();
  const Local bounds = local();
  const auto values = localData(x), isFree = localData(face.isFree);
  for (const auto& [entry, leader, slope] : growth_)
    if (const Interval interval = bounds[entry];
        isFree[leader] != 0 && isFree[entry] == 0 && interval.lower < interval.upper)
      face.followers.push_back({leader, entry, values[entry] < interval.upper ? -slope : slope});
}

void Box::releases(const Vector& x, const Vector& g, const Vector& s, double least, Vector& y) const {
  const Local bounds = local();
  const auto values = localData(x), gradient = localData(g), shift = localData(s);
  const auto result = localDataNonConst(y);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Interval interval = bounds[i];
    result[i] = infinity;
    if (interval.isFree(values[i]) || !(interval.lower < interval.upper))
      continue;
    const double outward = values[i] <= interval.lower ? -1 : 1;
    if (outward * shift[i] > least)
      result[i] = std::max(-outward * gradient[i], 0.0) / (outward * shift[i]);
  }
}

Box Box::shifted(const Vector& x) const {
  const auto less = [&x](const RCP<const Vector>& bound) {
    RCP<Vector> result;
    if (!bound.is_null()) {
      result = rcp(new Vector(*bound, Teuchos::Copy));
      result->update(-1.0, x, 1.0);
    }
    return result;
  };
  return Box(less(lower_), less(upper_), growth_);
}

Box Box::cone(const RCP<const Map>& map) const {
  const RCP<Vector> lower = rcp(new Vector(map)), upper = rcp(new Vector(map));
  const Local bounds = local();
  const auto low = localDataNonConst(*lower), high = localDataNonConst(*upper);
  for (std::size_t i = 0; i < low.size(); ++i) {
    low[i] = std::isfinite(bounds[i].lower) ? 0.0 : -infinity;
    high[i] = std::isfinite(bounds[i].upper) ? 0.0 : infinity;
  }
  return Box(lower, upper);
}

RCP<const ConvexSet> Box::shiftedBy(const Vector& x) const {
  return rcp(new Box(shifted(x)));
}

RCP<const ConvexSet> Box::recessionCone(const RCP<const Map>& map) const {
  return rcp(new Box(cone(map)));
}

} // namespace epafi::qp
