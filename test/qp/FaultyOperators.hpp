#pragma once

/// Operators that go wrong, are slow, or count.

#include "support/Problems.hpp"

#include <chrono>
#include <limits>
#include <thread>

namespace epafi::test {

/// A dense matrix whose products hold `value` in entry `row` from product number `healthy` on.
class FaultyOperator final : public Operator {
public:
  FaultyOperator(RCP<const Map> map, const Eigen::MatrixXd& matrix, int healthy, int row,
                 double value = std::numeric_limits<double>::quiet_NaN())
      : inner_(std::move(map), matrix), healthy_(healthy), row_(row), value_(value) {}
  RCP<const Map> getDomainMap() const override { return inner_.getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return inner_.getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
             double beta) const override {
    inner_.apply(x, y, mode, alpha, beta);
    if (inner_.applications > healthy_ && getRangeMap()->isNodeGlobalElement(row_))
      for (std::size_t column = 0; column < y.getNumVectors(); ++column)
        y.replaceGlobalValue(row_, column, value_);
  }
  int applications() const { return inner_.applications; }

private:
  DenseOperator inner_;
  int healthy_, row_;
  double value_;
};

/// Takes `milliseconds` for every product.
class SlowOperator final : public Operator {
public:
  SlowOperator(RCP<const Map> map, const Eigen::MatrixXd& matrix, int milliseconds)
      : inner_(std::move(map), matrix), milliseconds_(milliseconds) {}
  RCP<const Map> getDomainMap() const override { return inner_.getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return inner_.getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
             double beta) const override {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds_));
    inner_.apply(x, y, mode, alpha, beta);
  }

private:
  DenseOperator inner_;
  int milliseconds_;
};

} // namespace epafi::test
