#pragma once

/// Sums that do not depend on the order of their terms. Every term is added without error to a pair of
/// doubles (Knuth's TwoSum; Ogita, Rump, Oishi, *SIAM J. Sci. Comput.* 26 (2005)), as if in twice the
/// precision, and rounded once at the end. What is built on them is the same on any number of ranks, to the
/// last digit.

#include "epafi/base/Types.hpp"

#include <memory>
#include <span>
#include <vector>

namespace epafi {

class AccurateSum {
public:
  AccurateSum() = default;
  explicit AccurateSum(double value) : high_(value) {} ///< a sum of one term
  /// Seven additions; infinity and NaN make the value NaN.
  void add(double term) {
    const double sum = high_ + term;
    const double rest = sum - high_;
    low_ += (high_ - (sum - rest)) + (term - rest); // what the first addition lost, exactly
    high_ = sum;
  }
  /// The terms of another sum.
  void add(const AccurateSum& other) {
    add(other.high_);
    low_ += other.low_;
  }
  [[nodiscard]] double value() const { return high_ + low_; } ///< the sum, rounded

private:
  double high_ = 0, low_ = 0;
};

/// Sums over the ranks, in place; one message. Collective.
void sumOverRanks(const Comm& comm, std::span<AccurateSum> sums);
/// Likewise, and rounds them into as many `values`.
void sumOverRanks(const Comm& comm, std::span<AccurateSum> sums, double* values);

/// Several sums and one minimum over all ranks in a single message: a CG step of MPRGP needs its dot products
/// and the longest feasible step together. Keeps what MPI needs for its messages, so that `reduce` allocates
/// nothing.
class FusedReduction {
public:
  /// \param numSums  number of sums. Not collective.
  FusedReduction(RCP<const Comm> comm, int numSums);

  /// The rank's own contributions to the sums before `reduce`, the sums over all ranks after it.
  [[nodiscard]] std::span<AccurateSum> sums() { return {values_.data(), values_.size() - 1}; }
  /// The sums after `reduce`, rounded.
  [[nodiscard]] double sum(int i) const { return values_[i].value(); }
  void setMinimum(double candidate) { values_.back() = AccurateSum(candidate); } ///< this rank's
  [[nodiscard]] double minimum() const { return values_.back().value(); }        ///< of all ranks

  /// Sets the sums to zero and the minimum to infinity.
  void clear();
  /// One message of 2(numSums + 1) numbers. Collective.
  void reduce();

private:
  struct Type;
  RCP<const Comm> comm_;
  std::vector<AccurateSum> values_;  ///< the sums, then the minimum
  std::shared_ptr<const Type> type_; ///< null on a single rank
};

/// xᵀy and ‖x‖. Collective.
double accurateDot(const Vector& x, const Vector& y);
double accurateNorm(const Vector& x); ///< likewise

} // namespace epafi
