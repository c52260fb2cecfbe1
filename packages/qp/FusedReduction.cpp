#include "epafi/qp/FusedReduction.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace epafi::qp {

FusedReduction::FusedReduction(RCP<const Comm> comm, int numSums)
    : values_(static_cast<std::size_t>(numSums) + 1), reduction_(std::move(comm), values_.size()) {
  clear();
}

void FusedReduction::clear() {
  std::fill(values_.begin(), values_.end(), AccurateSum());
  setMinimum(std::numeric_limits<double>::infinity());
}

void FusedReduction::reduce() {
  reduction_.reduce(values_);
}

} // namespace epafi::qp
