#include "epafi/accuracy/WantedSizes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace epafi::accuracy {
namespace {

// Of the search for what is to be asked for, where more comes: its first step down, as a power of two of the
// number of parts of elements of order 1, and its steps.
constexpr double span = 2;
constexpr int numTrials = 5;

/// The family of meshes that are best for some error, from coarse to fine.
class BestMeshes {
public:
  BestMeshes(std::span<const double> squaredErrors, std::span<const double> orders,
             const RefinementGoal& goal)
      : errors_(squaredErrors), least_(-goal.dimension * goal.coarsening),
        most_(goal.dimension * goal.mostHalvings) {
    for (std::size_t e = 0; e < errors_.size(); ++e) {
      decay_.push_back(2 * orders[e] / goal.dimension);
      weight_.push_back(errors_[e] > 0 ? std::log2(decay_[e] * errors_[e]) : -1e300);
    }
  }

  /// log₂ n of an element; `level` is that of the multiplier.
  [[nodiscard]] double parts(std::size_t element, double level) const {
    return std::clamp((level + weight_[element]) / (1 + decay_[element]), least_, most_);
  }
  [[nodiscard]] double elements(double level) const {
    double sum = 0;
    for (std::size_t e = 0; e < errors_.size(); ++e)
      sum += std::exp2(parts(e, level));
    return sum;
  }
  [[nodiscard]] double squaredError(double level) const {
    double sum = 0;
    for (std::size_t e = 0; e < errors_.size(); ++e)
      sum += errors_[e] * std::exp2(-decay_[e] * parts(e, level));
    return sum;
  }
  /// The error of elements cut into n parts each.
  [[nodiscard]] double squaredErrorOf(std::span<const double> n) const {
    double sum = 0;
    for (std::size_t e = 0; e < errors_.size(); ++e)
      sum += errors_[e] * std::pow(n[e], -decay_[e]);
    return sum;
  }
  /// Whether the error is small enough, or most of it is in elements that can get no smaller at once: what
  /// the others add is no matter then.
  [[nodiscard]] bool isFineEnough(double level, double squaredGoal) const {
    double free = 0, stuck = 0;
    for (std::size_t e = 0; e < errors_.size(); ++e) {
      const double n = parts(e, level);
      (n < most_ ? free : stuck) += errors_[e] * std::exp2(-decay_[e] * n);
    }
    return free <= std::max(squaredGoal - stuck, stuck);
  }
  /// The coarsest level at which something holds that holds at all finer ones.
  template <class Property>
  [[nodiscard]] double first(const Property& holds) const {
    const double top = *std::max_element(weight_.begin(), weight_.end());
    double low = -top + 10 * least_, high = low + 400;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (holds(middle) ? high : low) = middle;
    }
    return high;
  }

private:
  std::span<const double> errors_;
  double least_, most_;
  std::vector<double> decay_, weight_; ///< 2q/d, log₂(2q/d η²)
};

} // namespace

WantedSizes wantedSizes(std::span<const double> squaredErrors, std::span<const double> orders,
                        const RefinementGoal& goal, const Outcome& outcome) {
  WantedSizes wanted;
  wanted.halvings.assign(squaredErrors.size(), 0);
  const auto number = static_cast<double>(squaredErrors.size());
  if (!(std::accumulate(squaredErrors.begin(), squaredErrors.end(), 0.0) > goal.error * goal.error))
    return wanted;
  const BestMeshes meshes(squaredErrors, orders, goal);
  double level = meshes.first([&](double l) { return meshes.isFineEnough(l, goal.error * goal.error); });
  const double whole = meshes.elements(level) / number;
  const double steps = std::max(1.0, std::ceil(std::log(whole) / std::log(goal.growth) - 1e-9));
  const double growth = std::max(std::pow(whole, 1 / steps), goal.leastGrowth);
  const bool isOnTheWay = steps > 1 || growth > whole;
  if (isOnTheWay)
    level = meshes.first([&](double l) { return meshes.elements(l) >= growth * number; });
  const auto take = [&](double l) {
    for (std::size_t e = 0; e < squaredErrors.size(); ++e)
      wanted.halvings[e] = meshes.parts(e, l) / goal.dimension;
    wanted.growth = meshes.elements(l) / number;
    wanted.error = std::sqrt(meshes.squaredError(l));
  };
  take(level);
  if (!outcome)
    return wanted;
  const double planned = wanted.error;
  double enough = level, tooFew = level - span * (1 + 2.0 / goal.dimension); // a fraction of the elements
  for (int i = 0; i <= numTrials; ++i) {
    const double trial = i < numTrials ? 0.5 * (enough + tooFew) : enough;
    take(trial);
    const std::vector<double> parts = outcome(wanted.halvings);
    wanted.growth = std::accumulate(parts.begin(), parts.end(), 0.0) / number;
    wanted.error = std::sqrt(meshes.squaredErrorOf(parts));
    const bool suffices = isOnTheWay ? wanted.growth >= growth : wanted.error <= planned;
    (suffices ? enough : tooFew) = trial;
  }
  return wanted;
}

} // namespace epafi::accuracy
