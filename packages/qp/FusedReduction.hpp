#pragma once

/// Several sums and one minimum over all ranks in a single message: a CG step of MPRGP needs its dot products
/// and the longest feasible step together.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Types.hpp"

#include <span>
#include <vector>

namespace epafi::qp {

class FusedReduction {
public:
  /// \param numSums  number of sums.
  FusedReduction(RCP<const Comm> comm, int numSums);

  /// The rank's own contributions to the sums before `reduce`, the sums over all ranks after it.
  [[nodiscard]] std::span<AccurateSum> sums() { return {values_.data(), values_.size() - 1}; }
  [[nodiscard]] double sum(int index) const { return values_[static_cast<std::size_t>(index)].value(); }
  /// The rank's own candidate for the minimum before `reduce`; the minimum after it.
  void setMinimum(double candidate) { values_.back() = AccurateSum(candidate); }
  [[nodiscard]] double minimum() const { return values_.back().value(); }

  /// Sets the sums to zero and the minimum to infinity.
  void clear();
  /// One message of 2(numSums + 1) numbers. Collective.
  void reduce();

private:
  std::vector<AccurateSum> values_; ///< the sums, then the minimum
  SumsAndMinimum reduction_;
};

} // namespace epafi::qp
