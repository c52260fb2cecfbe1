#pragma once

/// Several sums and one minimum over all ranks in a single message: a CG step of MPRGP needs its dot products
/// and the longest feasible step together.

#include "epafi/base/Types.hpp"

#include <span>
#include <vector>

namespace epafi::qp {

class FusedReduction {
public:
  /// \param numSums  number of sums.
  FusedReduction(RCP<const Comm> comm, int numSums);

  /// The rank's own contributions to the sums before `reduce`, the sums over all ranks after it.
  [[nodiscard]] std::span<double> sums() { return {values_.data(), values_.size() - 1}; }
  /// The rank's own candidate for the minimum before `reduce`, the minimum after it.
  [[nodiscard]] double& minimum() { return values_.back(); }

  /// Sets the sums to zero and the minimum to infinity.
  void clear();
  /// One reduction of numSums + 1 numbers. Collective.
  void reduce();

private:
  RCP<const Comm> comm_;
  std::vector<double> values_, mine_;
};

} // namespace epafi::qp
