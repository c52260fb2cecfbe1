#include "epafi/accuracy/WantedSizes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace epafi::accuracy {
namespace {

/// The family of meshes that are best for some error, from coarse to fine: log₂ of parts an element is clamped `level` + log₂ n.
class BestMeshes {
public:
  BestMeshes(std::span<const double> squaredErrors, const RefinementGoal& goal)
      : errors_(squaredErrors), dimension_(goal.dimension), decay_(2.0 * goal.order / goal.dimension),
        least_(-goal.dimension * goal.coarsening), most_(goal.dimension * goal.mostHalvings) {
    for (const double error : errors_)
      parts_.push_back(error > 0 ? std::log2(error) / (1 + decay_) : -1e300);
  }

  [[nodiscard]] double parts(std::size_t element, double level) const {
    return std::clamp(level + parts_[element], least_, most_);
  }
  [[nodiscard]] double elements(double level) const {
    double sum = 0;
    for (std::size_t e = 0; e < parts_.size(); ++e)
      sum += std::exp2(parts(e, level));
    return sum;
  }
  [[nodiscard]] double squaredError(double level) const {
    double sum = 0;
    for (std::size_t e = 0; e < parts_.size(); ++e)
      sum += errors_[e] * std::exp2(-decay_ * parts(e, level));
    return sum;
  }
  /// The coarsest level at which something holds that holds at all finer ones.
  template <class Property>
  [[nodiscard]] double first(const Property& holds) const {
    const double top = *std::max_element(parts_.begin(), parts_.end());
    double low = -top + least_, high = low + 200;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (holds(middle) ? high : low) = middle;
    }
    return high;
  }
  [[nodiscard]] int dimension() const { return dimension_; }

private:
  std::span<const double> errors_;
  int dimension_;
  double decay_, least_, most_;
  std::vector<double> parts_; ///< log₂ of a level's parts but for the level
};

} // namespace

WantedSizes wantedSizes(std::span<const double> squaredErrors, const RefinementGoal& goal) {
  WantedSizes wanted;
  wanted.halvings.assign(squaredErrors.size(), 0);
  const auto number = static_cast<double>(squaredErrors.size());
  if (!(std::accumulate(squaredErrors.begin(), squaredErrors.end(), 0.0) > goal.error * goal.error))
    return wanted;
  const BestMeshes meshes(squaredErrors, goal);
  double level =
      meshes.first([&](double l) { return meshes.squaredError(l) <= goal.error * goal.error; });
  const double whole = meshes.elements(level) / number;
  const double steps = std::max(1.0, std::ceil(std::log(whole) / std::log(goal.growth) - 1e-9));
  if (steps > 1)
    level = meshes.first(
        [&](double l) { return meshes.elements(l) >= std::pow(whole, 1 / steps) * number; });
  for (std::size_t e = 0; e < squaredErrors.size(); ++e)
    wanted.halvings[e] = meshes.parts(e, level) / goal.dimension;
  wanted.growth = meshes.elements(level) / number;
  return wanted;
}

} // namespace epafi::accuracy
