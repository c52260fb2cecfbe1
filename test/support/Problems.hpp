#pragma once

/// Small problems on any number of ranks, with dense copies for certificates.

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Types.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <Eigen/Dense>
#include <Teuchos_Comm.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <functional>
#include <limits>
#include <random>

namespace epafi::test {

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

/// n entries, spread as evenly as Tpetra does; some ranks own none if n is small.
inline RCP<const Map> linearMap(int n, const RCP<const Comm>& comm = Tpetra::getDefaultComm()) {
  return rcp(new Map(static_cast<std::size_t>(n), 0, comm));
}

/// Entry i is values(i).
inline RCP<Vector> makeVector(const RCP<const Map>& map, const std::function<double(int)>& values) {
  const RCP<Vector> x = rcp(new Vector(map));
  for (std::size_t i = 0; i < numLocal(*map); ++i)
    x->replaceLocalValue(static_cast<LocalOrdinal>(i),
                         values(static_cast<int>(map->getGlobalElement(static_cast<LocalOrdinal>(i)))));
  return x;
}

inline RCP<Vector> makeVector(const RCP<const Map>& map, const Eigen::VectorXd& values) {
  return makeVector(map, [&](int i) { return values[i]; });
}

/// The whole vector on every rank.
inline Eigen::VectorXd gather(const Vector& x) {
  const Eigen::Index n = x.getGlobalLength();
  Eigen::VectorXd mine = Eigen::VectorXd::Zero(n), all = Eigen::VectorXd::Zero(n);
  const auto values = qp::localData(x);
  for (std::size_t i = 0; i < values.size(); ++i)
    mine[x.getMap()->getGlobalElement(static_cast<LocalOrdinal>(i))] = values[i];
  Teuchos::reduceAll(*x.getMap()->getComm(), Teuchos::REDUCE_SUM, static_cast<int>(n), mine.data(),
                     all.data());
  return all;
}

/// A dense matrix, known on every rank, as an operator.
class DenseOperator final : public Operator {
public:
  DenseOperator(RCP<const Map> map, Eigen::MatrixXd matrix)
      : map_(std::move(map)), matrix_(std::move(matrix)) {}
  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
      const Eigen::VectorXd image = matrix_ * gather(*x.getVector(column));
      y.getVectorNonConst(column)->update(alpha, *makeVector(map_, image), beta);
    }
    ++applications;
  }
  const Eigen::MatrixXd& matrix() const { return matrix_; }
  mutable int applications = 0;

private:
  RCP<const Map> map_;
  Eigen::MatrixXd matrix_;
};

/// A dense m × n matrix, known on every rank, as an operator with a transposed apply.
class DenseRows final : public Operator {
public:
  DenseRows(RCP<const Map> domain, RCP<const Map> range, Eigen::MatrixXd matrix)
      : domain_(std::move(domain)), range_(std::move(range)), matrix_(std::move(matrix)) {}
  RCP<const Map> getDomainMap() const override { return domain_; }
  RCP<const Map> getRangeMap() const override { return range_; }
  bool hasTransposeApply() const override { return true; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
             double beta) const override {
    const bool isTransposed = mode != Teuchos::NO_TRANS;
    for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
      const Eigen::VectorXd in = gather(*x.getVector(column));
      const Eigen::VectorXd image = isTransposed ? Eigen::VectorXd(matrix_.transpose() * in) : matrix_ * in;
      y.getVectorNonConst(column)->update(alpha, *makeVector(isTransposed ? domain_ : range_, image), beta);
    }
  }

private:
  RCP<const Map> domain_, range_;
  Eigen::MatrixXd matrix_;
};

/// Orthonormal rows, known on every rank.
class DenseEquality final : public qp::ReplicatedEquality {
public:
  DenseEquality(RCP<const Map> map, Eigen::MatrixXd rows) : map_(std::move(map)), rows_(std::move(rows)) {}
  int size() const override { return static_cast<int>(rows_.rows()); }
  void addLocalProduct(const Vector& x, std::span<AccurateSum> gx) const override {
    const auto values = qp::localData(x);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t k = 0; k < gx.size(); ++k)
        gx[k].add(rows_(static_cast<Eigen::Index>(k),
                        static_cast<Eigen::Index>(map_->getGlobalElement(static_cast<LocalOrdinal>(i)))) *
                  values[i]);
  }
  void addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const override {
    const auto values = qp::localDataNonConst(y);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t k = 0; k < mu.size(); ++k)
        values[i] += factor * mu[k] *
                     rows_(static_cast<Eigen::Index>(k),
                           static_cast<Eigen::Index>(map_->getGlobalElement(static_cast<LocalOrdinal>(i))));
  }
  const Eigen::MatrixXd& rows() const { return rows_; }

private:
  RCP<const Map> map_;
  Eigen::MatrixXd rows_;
};

/// Random orthogonal matrix; the same on all ranks.
inline Eigen::MatrixXd randomOrthogonal(int n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd a(n, n);
  for (Eigen::Index i = 0; i < a.size(); ++i)
    a.data()[i] = normal(random);
  return direct::orthonormalBasis(a);
}

/// SPD with eigenvalues spread evenly (in the exponent) from 1/condition to 1.
inline Eigen::MatrixXd randomSpd(int n, double condition, std::mt19937& random) {
  const Eigen::MatrixXd q = randomOrthogonal(n, random);
  Eigen::VectorXd eigenvalues(n);
  for (int i = 0; i < n; ++i)
    eigenvalues[i] = std::pow(condition, n > 1 ? -static_cast<double>(i) / (n - 1) : 0.0);
  const Eigen::MatrixXd a = q * eigenvalues.asDiagonal() * q.transpose();
  return 0.5 * (a + a.transpose());
}

} // namespace epafi::test
