#include "epafi/qp/FusedReduction.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace epafi::qp {

FusedReduction::FusedReduction(RCP<const Comm> comm, int numSums)
    : comm_(std::move(comm)), values_(static_cast<std::size_t>(numSums) + 1) {
  clear();
}

void FusedReduction::clear() {
  std::fill(values_.begin(), values_.end(), AccurateSum());
  setMinimum(std::numeric_limits<double>::infinity());
}

void FusedReduction::reduce() {
  sumAndMinimumOverRanks(*comm_, values_);
}

} // namespace epafi::qp
