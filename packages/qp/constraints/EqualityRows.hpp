#pragma once

/// The rows of a given B as SMALBE takes them: made orthonormal, or as they are. MatrixEquality.hpp chooses.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace epafi::qp {

/// W(Bx − c) with WBBᵀWᵀ = I. W is r × m; a rank keeps the columns of its own rows of B.
class OrthonormalEquality final : public ReplicatedEquality {
public:
  /// \param w  this rank's columns of W, one after the other
  /// \param c  Wc
  OrthonormalEquality(RCP<const Operator> b, std::vector<double> w, std::vector<double> c)
      : b_(std::move(b)), w_(std::move(w)), c_(std::move(c)), rows_(b_->getRangeMap()),
        transposed_(b_->getDomainMap()) {}

  [[nodiscard]] int size() const override { return static_cast<int>(c_.size()); }
  [[nodiscard]] bool isHomogeneous() const override { return false; }
  [[nodiscard]] std::span<const double> rightHandSide() const override { return c_; }

  void addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const override {
    b_->apply(x, rows_);
    const auto bx = localData(rows_);
    for (std::size_t i = 0; i < bx.size(); ++i)
      for (std::size_t k = 0; k < sums.size(); ++k)
        sums[k].add(w_[i * sums.size() + k] * bx[i]);
  }
  void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const override {
    combine(mu, rows_);
    b_->apply(rows_, transposed_, Teuchos::TRANS);
    y.update(factor, transposed_, 1.0);
  }
  /// y = Wᵀμ.
  void combine(std::span<const double> mu, Vector& y) const {
    const auto values = localDataNonConst(y);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = 0;
      for (std::size_t k = 0; k < mu.size(); ++k)
        values[i] += w_[i * mu.size() + k] * mu[k];
    }
  }

private:
  RCP<const Operator> b_;
  std::vector<double> w_, c_;
  mutable Vector rows_, transposed_;
};

/// (Bx − c)/‖B‖, its rows where B has them.
class ScaledEquality final : public EqualityConstraint {
public:
  ScaledEquality(RCP<const Operator> b, const RCP<const Vector>& c, double scale)
      : b_(std::move(b)), scale_(scale), isHomogeneous_(c.is_null()), rows_(b_->getRangeMap()),
        transposed_(b_->getDomainMap()) {
    if (!c.is_null())
      for (const double value : localData(*c))
        c_.push_back(scale * value);
  }
  [[nodiscard]] std::size_t numEntries() const override { return rows_.getLocalLength(); }
  [[nodiscard]] bool isReplicated() const override { return false; }
  [[nodiscard]] double norm() const override { return 1; }
  [[nodiscard]] int numSums() const override { return 1; }
  [[nodiscard]] bool isHomogeneous() const override { return isHomogeneous_; }
  [[nodiscard]] std::span<const double> rightHandSide() const override { return c_; }

  void addLocalSums(const Vector& x, std::span<AccurateSum> sums) const override {
    b_->apply(x, rows_);
    const auto r = localDataNonConst(rows_);
    for (std::size_t i = 0; i < r.size(); ++i) {
      r[i] = scale_ * r[i] - (c_.empty() ? 0.0 : c_[i]);
      sums[0].add(r[i] * r[i]);
    }
  }
  double finishResidual(std::span<const AccurateSum> sums, std::span<double> r,
                        std::span<double> weighed) const override {
    const auto values = localData(rows_);
    std::copy(values.begin(), values.end(), r.begin());
    std::copy(values.begin(), values.end(), weighed.begin());
    return std::sqrt(sums[0].value());
  }
  void product(const Vector& x, std::span<double> bx) const override {
    b_->apply(x, rows_);
    const auto values = localData(rows_);
    std::transform(values.begin(), values.end(), bx.begin(), [this](double value) { return scale_ * value; });
  }
  void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const override {
    const auto values = localDataNonConst(rows_);
    std::copy(mu.begin(), mu.end(), values.begin());
    b_->apply(rows_, transposed_, Teuchos::TRANS);
    y.update(scale_ * factor, transposed_, 1.0);
  }
  [[nodiscard]] double dot(std::span<const double> mu, std::span<const double> r) const override {
    AccurateSum sum;
    for (std::size_t i = 0; i < mu.size(); ++i)
      sum.add(mu[i] * r[i]);
    sumOverRanks(*rows_.getMap()->getComm(), {&sum, 1});
    return sum.value();
  }

private:
  RCP<const Operator> b_;
  double scale_;
  bool isHomogeneous_;
  std::vector<double> c_;
  mutable Vector rows_, transposed_;
};

} // namespace epafi::qp
