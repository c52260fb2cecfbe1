#pragma once

/// Sums that do not depend on the order of their terms. Every term is added without error to a pair of
/// doubles (Knuth's TwoSum; Ogita, Rump, Oishi, *SIAM J. Sci. Comput.* 26 (2005)), as if in twice the
/// precision, and rounded once at the end. What is built on them is the same on any number of ranks, to the
/// last digit.

#include "epafi/base/Types.hpp"

#include <memory>
#include <span>

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

/// The same for all values but the last one, of which the smallest is taken. The object keeps what MPI needs for
/// messages of its length, so that `reduce` allocates nothing.
class SumsAndMinimum {
public:
  /// \param length  number of values, the minimum included. Not collective.
  SumsAndMinimum(RCP<const Comm> comm, std::size_t length);
  SumsAndMinimum(SumsAndMinimum&& other) noexcept;
  SumsAndMinimum& operator=(SumsAndMinimum&& other) noexcept;
  SumsAndMinimum(const SumsAndMinimum&) = delete;
  SumsAndMinimum& operator=(const SumsAndMinimum&) = delete;
  ~SumsAndMinimum();
  /// In place; one message. Collective.
  void reduce(std::span<AccurateSum> sumsAndMinimum) const;

private:
  struct Type;
  RCP<const Comm> comm_;
  std::unique_ptr<Type> type_; ///< null on a single rank
};

/// xᵀy and ‖x‖. Collective.
double accurateDot(const Vector& x, const Vector& y);
double accurateNorm(const Vector& x); ///< likewise

} // namespace epafi
