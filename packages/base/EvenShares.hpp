#pragma once

/// Rows of small dense matrices, spread over all ranks as evenly as can be: rank r of P has rN/P to (r +
/// 1)N/P.

#include "epafi/base/Types.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace epafi {

class EvenShares {
public:
  /// \param number  N, the same on every rank. Not collective.
  EvenShares(RCP<const Comm> comm, int number);

  [[nodiscard]] int first() const;                                   ///< this rank's first row
  [[nodiscard]] int size() const;                                    ///< and how many it has
  [[nodiscard]] int first(int rank) const { return offsets_[rank]; } ///< of any rank
  [[nodiscard]] int size(int rank) const { return counts_[rank]; }   ///< likewise
  /// Puts each rank's numbers into `all`, N of them, on every rank; one message, and nothing is allocated.
  /// Collective.
  void gather(std::span<const double> mine, std::span<double> all) const;

private:
  RCP<const Comm> comm_;
  std::vector<int> counts_, offsets_; ///< of each rank
};

} // namespace epafi
