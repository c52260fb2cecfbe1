#include "epafi/accuracy/LocalOrders.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::accuracy {

std::vector<double> localOrders(const ElementErrors& last, std::span<const LocalOrdinal> ancestors,
                                std::span<const double> squaredErrors, std::span<const double> measures,
                                int dimension, int order) {
  struct Heirs {
    double squaredError = 0, measure = 0, number = 0;
  };
  std::vector<Heirs> heirs(last.squared.size());
  for (std::size_t e = 0; e < ancestors.size(); ++e) {
    Heirs& own = heirs[ancestors[e]];
    own.squaredError += squaredErrors[e];
    own.measure += measures[e];
    ++own.number;
  }
  constexpr double leastOrder = 0.4, clear = 0.3, doubt = 1; // halvings
  std::vector<double> orders(last.orders);
  for (std::size_t t = 0; t < heirs.size(); ++t) {
    const Heirs& own = heirs[t];
    if (own.number == 0)
      continue;
    const double halvings = std::log2(last.measures[t] * own.number / own.measure) / dimension;
    const double before = last.squared[t] * own.measure / last.measures[t];
    if (!(halvings >= clear && before > 0 && own.squaredError > 0))
      continue;
    const double seen = std::clamp(0.5 * std::log2(before / own.squaredError) / halvings, leastOrder,
                                   static_cast<double>(order));
    orders[t] += (seen - orders[t]) * halvings / (halvings + doubt);
  }
  std::vector<double> result;
  for (const LocalOrdinal ancestor : ancestors)
    result.push_back(orders[ancestor]);
  return result;
}

} // namespace epafi::accuracy
