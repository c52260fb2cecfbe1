#include "epafi/qp/constraints/Discs.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

namespace epafi::qp {
namespace {

using Pair = Disc::Pair;

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double rimShare =
    4e-15; ///< of radius and centre, whose round-off x has: nearer the circle x is on it

Pair pairOf(const Disc& disc, std::span<const double> values) {
  return {values[disc.first], values[disc.second]};
}

Pair both(double value) {
  return {value, value};
}

void setPair(const Disc& disc, const Pair& pair, std::span<double> values) {
  values[disc.first] = pair.first;
  values[disc.second] = pair.second;
}

/// The box with −bound and bound in the entries of discs.
Box boxBeside(const Box& box, const std::vector<Disc>& discs, const RCP<const Map>& map, double bound) {
  const RCP<Vector> lower = rcp(new Vector(map)), upper = rcp(new Vector(map));
  const Box::Local bounds = box.local();
  const auto low = localDataNonConst(*lower), high = localDataNonConst(*upper);
  for (std::size_t i = 0; i < low.size(); ++i) {
    low[i] = bounds[i].lower;
    high[i] = bounds[i].upper;
  }
  for (const Disc& disc : discs) {
    setPair(disc, {-bound, -bound}, low);
    setPair(disc, {bound, bound}, high);
  }
  return Box(lower, upper);
}

} // namespace

bool Disc::isFree(const Pair& x) const {
  return (x - centre).norm() < radius - rimShare * (radius + centre.norm());
}

Pair Disc::outward(const Pair& x) const {
  const Pair out = x - centre;
  const double length = out.norm();
  return length > 0 ? 1 / length * out : Pair();
}

Pair Disc::project(const Pair& x) const {
  const double length = (x - centre).norm();
  return length > radius ? centre + radius / length * (x - centre) : x;
}

Pair Disc::choppedGradient(const Pair& x, const Pair& g, double negligible) const {
  if (!(radius > 0) || isFree(x))
    return Pair();
  const Pair normal = outward(x);
  const double inward = g.dot(normal); // x moves against g
  const Pair chopped = inward > 0 ? g : g - inward * normal;
  return chopped.norm() > negligible ? chopped : Pair();
}

Pair Disc::reducedFreeGradient(const Pair& x, const Pair& g, double step) const {
  return 1 / step * (x - project(x - step * g));
}

double Disc::maxFeasibleStep(const Pair& x, const Pair& p) const {
  const double squared = p.squaredNorm(), inward = p.dot(x - centre);
  if (squared == 0)
    return endless;
  const double room = std::max(0.0, radius * radius - (x - centre).squaredNorm());
  const double root = std::sqrt(inward * inward + squared * room);
  return inward > 0 ? (inward + root) / squared : room == 0 ? 0.0 : room / (root - inward);
}

Discs::Discs(const Box& box, std::vector<Disc> discs, const RCP<const Map>& map)
    : map_(map), box_(boxBeside(box, discs, map, endless)), discs_(std::move(discs)) {}

std::string Discs::emptiness(const Map& map) const {
  std::string found = box_.emptiness(map);
  collectively(*map.getComm(), [&] {
    for (const Disc& disc : discs_)
      if (!(disc.radius >= 0) || !std::isfinite(disc.radius) || !std::isfinite(disc.centre.norm()))
        throw InputError("the disc of entry " + std::to_string(map.getGlobalElement(disc.first)) +
                         " has the radius " + text(disc.radius) + "; it must be a finite number, at least 0");
  });
  return found;
}

void Discs::project(Vector& x) const {
  box_.project(x);
  const auto values = localDataNonConst(x);
  for (const Disc& disc : discs_)
    setPair(disc, disc.project(pairOf(disc, values)), values);
}

void Discs::move(double length, const Vector& p, Vector& x) const {
  box_.move(length, p, x);
  const auto values = localDataNonConst(x);
  for (const Disc& disc : discs_)
    setPair(disc, disc.project(pairOf(disc, values)), values);
}

double Discs::maxFeasibleStep(const Vector& x, const Vector& p) const {
  double longest = box_.maxFeasibleStep(x, p);
  const auto values = localData(x), direction = localData(p);
  for (const Disc& disc : discs_)
    longest = std::min(longest, disc.maxFeasibleStep(pairOf(disc, values), pairOf(disc, direction)));
  return longest;
}

/// The box has counted the pairs as free; sums lose no digit when a term is taken off again.
GradientSums Discs::measure(const Vector& x, const Vector& g, const Vector& image, double step) const {
  GradientSums sums = box_.measure(x, g, image, step);
  const auto values = localData(x), gradient = localData(g), w = localData(image);
  for (const Disc& disc : discs_) {
    const Pair here = pairOf(disc, values), slope = pairOf(disc, gradient), ap = pairOf(disc, w);
    sums.reducedTimesFree.add(-(slope.first * slope.first));
    sums.reducedTimesFree.add(-(slope.second * slope.second));
    if (disc.isFree(here)) {
      sums.reducedTimesFree.add(slope.dot(disc.reducedFreeGradient(here, slope, step)));
      continue;
    }
    sums.freeSquared.add(-(slope.first * slope.first));
    sums.freeSquared.add(-(slope.second * slope.second));
    sums.freeTimesImage.add(-(slope.first * ap.first));
    sums.freeTimesImage.add(-(slope.second * ap.second));
    sums.choppedSquared.add(disc.choppedGradient(here, slope).squaredNorm());
    sums.active += 2;
  }
  return sums;
}

void Discs::subtractFromFreeGradient(const Vector& x, const Vector& g, double factor, Vector& y) const {
  const auto values = localData(x), gradient = localData(g);
  box_.subtractFromFreeGradient(x, g, factor, y);
  const auto result = localDataNonConst(y);
  for (const Disc& disc : discs_)
    if (!disc.isFree(pairOf(disc, values)))
      setPair(disc, pairOf(disc, result) - pairOf(disc, gradient), result);
}

void Discs::choppedGradient(const Vector& x, const Vector& g, double negligible, Vector& y) const {
  box_.choppedGradient(x, g, negligible, y);
  const auto values = localData(x), gradient = localData(g);
  const auto result = localDataNonConst(y);
  for (const Disc& disc : discs_)
    setPair(disc, disc.choppedGradient(pairOf(disc, values), pairOf(disc, gradient), negligible), result);
}

void Discs::projectedGradient(const Vector& x, const Vector& g, double negligible, Vector& y) const {
  box_.projectedGradient(x, g, negligible, y);
  const auto values = localData(x), gradient = localData(g);
  const auto result = localDataNonConst(y);
  for (const Disc& disc : discs_)
    if (const Pair here = pairOf(disc, values); !disc.isFree(here))
      setPair(disc, disc.choppedGradient(here, pairOf(disc, gradient), negligible), result);
}

void Discs::restrictToFree(const Vector& x, Vector& z) const {
  box_.restrictToFree(x, z);
  const auto values = localData(x);
  const auto result = localDataNonConst(z);
  for (const Disc& disc : discs_)
    if (!disc.isFree(pairOf(disc, values)))
      setPair(disc, Pair(), result);
}

/// On a circle where g leads along it, z does too; where g leads inside, z may.
void Discs::restrictToReleased(const Vector& x, const Vector& g, double negligible, Vector& z) const {
  box_.restrictToReleased(x, g, negligible, z);
  const auto values = localData(x), gradient = localData(g);
  const auto result = localDataNonConst(z);
  for (const Disc& disc : discs_) {
    const Pair here = pairOf(disc, values), slope = pairOf(disc, gradient), normal = disc.outward(here);
    if (disc.isFree(here))
      continue;
    const Pair direction = pairOf(disc, result);
    const bool isReleased = !disc.choppedGradient(here, slope, negligible).isZero();
    const double inward = direction.dot(normal),
                 most = slope.dot(normal) > 0 ? std::min(0.0, inward) : inward;
    setPair(disc, isReleased ? direction - most * normal : Pair(), result);
  }
}

void Discs::freeIndicator(const Vector& x, Vector& y) const {
  box_.freeIndicator(x, y);
  const auto values = localData(x);
  const auto result = localDataNonConst(y);
  for (const Disc& disc : discs_)
    setPair(disc, both(disc.isFree(pairOf(disc, values)) ? 1 : 0), result);
}

void Discs::fixedIndicator(Vector& y) const {
  box_.fixedIndicator(y);
  const auto result = localDataNonConst(y);
  for (const Disc& disc : discs_)
    setPair(disc, both(disc.radius > 0 ? 0 : 1), result);
}

void Discs::distanceToBoundary(const Vector& x, double atMost, Vector& y) const {
  box_.distanceToBoundary(x, atMost, y);
  const auto values = localData(x);
  const auto result = localDataNonConst(y);
  for (const Disc& disc : discs_) {
    const Pair here = pairOf(disc, values);
    const double room = disc.isFree(here) ? (disc.radius - (here - disc.centre).norm()) / std::sqrt(2.0) : 0;
    setPair(disc, both(std::min(room, atMost)), result);
  }
}

void Discs::activate(const Vector& active, Vector& x) const {
  box_.activate(active, x);
  const auto isActive = localData(active);
  const auto values = localDataNonConst(x);
  for (const Disc& disc : discs_)
    if (isActive[disc.first] != 0 || isActive[disc.second] != 0)
      setPair(disc, disc.centre + disc.radius * disc.outward(pairOf(disc, values)), values);
}

double Discs::complementarity(const Vector& x, const Vector& g, double scale) const {
  double largest = box_.complementarity(x, withoutPairs(g), scale);
  const auto values = localData(x), gradient = localData(g);
  for (const Disc& disc : discs_) {
    const Pair slope = pairOf(disc, gradient);
    if (const double size = slope.norm(); size > 0)
      largest =
          std::max(largest, std::min(size, scale * size * disc.maxFeasibleStep(pairOf(disc, values), slope)));
  }
  return largest;
}

double Discs::longestMultiplierStep(const Vector& x, const Vector& g, const Vector& s) const {
  double longest = box_.longestMultiplierStep(x, g, withoutPairs(s));
  const auto values = localData(x), gradient = localData(g), shift = localData(s);
  for (const Disc& disc : discs_) {
    const Pair here = pairOf(disc, values), change = pairOf(disc, shift), normal = disc.outward(here);
    if (change.isZero() || !(disc.radius > 0))
      continue;
    const double outwards = change.dot(normal);
    if (disc.isFree(here) || (change - outwards * normal).norm() > 1e-12 * change.norm())
      return 0;
    if (outwards > 0)
      longest = std::min(longest, -pairOf(disc, gradient).dot(normal) / outwards);
  }
  return longest;
}

RCP<const ConvexSet> Discs::shiftedBy(const Vector& x) const {
  const auto values = localData(x);
  std::vector<Disc> discs = discs_;
  for (Disc& disc : discs)
    disc.centre = disc.centre - pairOf(disc, values);
  return rcp(new Discs(box_.shifted(x), std::move(discs), map_));
}

RCP<const ConvexSet> Discs::recessionCone(const RCP<const Map>& map) const {
  return rcp(new Box(boxBeside(box_.cone(map), discs_, map, 0.0)));
}

void Discs::followBoundary(const Vector& x, const Vector& g, double least, const Face* from,
                           Face& face) const {
  const auto values = localData(x), gradient = localData(g);
  const auto isFree = localDataNonConst(face.isFree);
  face.tangents.clear();
  face.followers.clear();
  std::span<const CircleTangent> last;
  if (from != nullptr)
    last = from->tangents;
  for (const Disc& disc : discs_) {
    while (!last.empty() && last.front().first < disc.first)
      last = last.subspan(1);
    const Pair here = pairOf(disc, values);
    if (!(disc.radius > 0))
      continue;
    setPair(disc, both(1), isFree);
    if (disc.isFree(here))
      continue;
    const bool followed = !last.empty() && last.front().first == disc.first;
    const Pair normal = disc.outward(here);
    const double inward = pairOf(disc, gradient).dot(normal);
    if (followed && inward > 0 && inward >= least)
      continue;
    const Pair along{-normal.second, normal.first};
    face.tangents.push_back(
        {disc.first, disc.second, {along.first, along.second}, along.dot(here), disc.radius});
    if (disc.slope > 0 && isFree[disc.leader] != 0) {
      face.followers.push_back({disc.leader, disc.first, disc.slope * normal.first});
      face.followers.push_back({disc.leader, disc.second, disc.slope * normal.second});
    }
  }
}

void Discs::releases(const Vector& x, const Vector& g, const Vector& s, double least, Vector& y) const {
  box_.releases(x, g, s, least, y);
  const auto values = localData(x), gradient = localData(g), shift = localData(s);
  const auto result = localDataNonConst(y);
  for (const Disc& disc : discs_) {
    const Pair here = pairOf(disc, values), normal = disc.outward(here);
    const double outwards = pairOf(disc, shift).dot(normal);
    const bool falls = disc.radius > 0 && !disc.isFree(here) && outwards > least;
    const double multiplier = std::max(0.0, -pairOf(disc, gradient).dot(normal));
    setPair(disc, both(falls ? multiplier / outwards : endless), result);
  }
}

/// x, but 0 in the pairs.
Vector Discs::withoutPairs(const Vector& x) const {
  Vector result(x, Teuchos::Copy);
  const auto values = localDataNonConst(result);
  for (const Disc& disc : discs_)
    setPair(disc, Pair(), values);
  return result;
}

} // namespace epafi::qp
