#include "epafi/qp/MatrixEquality.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Columns.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/qp/LocalData.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace epafi::qp {
namespace {

/// Eigenvalues of BBᵀ (rows of length 1) below this belong to redundant rows.
constexpr double zeroEigenvalue = 1e-14;
/// A right-hand side that the rows cannot give is a contradiction if its share is larger than this.
constexpr double zeroShare = 1e-9;

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
  double finishResidual(std::span<const AccurateSum> sums, std::span<double> r) const override {
    const auto values = localData(rows_);
    std::copy(values.begin(), values.end(), r.begin());
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
  [[nodiscard]] double dot(std::span<const double> a, std::span<const double> b) const override {
    AccurateSum sum;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum.add(a[i] * b[i]);
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

/// BBᵀ as an operator, for its norm.
class GramOperator final : public Operator {
public:
  explicit GramOperator(RCP<const Operator> b) : b_(std::move(b)), transposed_(b_->getDomainMap()) {}
  [[nodiscard]] RCP<const Map> getDomainMap() const override { return b_->getRangeMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return b_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
             double beta) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      b_->apply(in, transposed_, Teuchos::TRANS);
      b_->apply(transposed_, out, Teuchos::NO_TRANS, alpha, beta);
    });
  }

private:
  RCP<const Operator> b_;
  mutable Vector transposed_;
};

/// The rows of B numbered from 0 over the ranks: the number of this rank's first one.
std::size_t firstRow(const Map& rows, std::size_t numLocalRows) {
  const auto mine = static_cast<GlobalOrdinal>(numLocalRows);
  GlobalOrdinal upToMine = 0;
  Teuchos::scan(*rows.getComm(), Teuchos::REDUCE_SUM, 1, &mine, &upToMine);
  return static_cast<std::size_t>(upToMine - mine);
}

/// BBᵀ, m × m on every rank, by 16 columns at a time.
std::vector<double> gramMatrix(const Operator& b, std::size_t m, std::size_t first) {
  constexpr std::size_t blockSize = 16;
  std::vector<double> gram(m * m, 0.0);
  for (std::size_t start = 0; start < m; start += blockSize) {
    const std::size_t width = std::min(blockSize, m - start);
    MultiVector unit(b.getRangeMap(), width), image(b.getDomainMap(), width), column(b.getRangeMap(), width);
    for (std::size_t j = 0; j < width; ++j)
      if (start + j >= first && start + j < first + unit.getLocalLength())
        unit.replaceLocalValue(static_cast<LocalOrdinal>(start + j - first), j, 1.0);
    b.apply(unit, image, Teuchos::TRANS);
    b.apply(image, column);
    for (std::size_t j = 0; j < width; ++j) {
      const auto values = column.getData(j);
      for (std::size_t i = 0; i < column.getLocalLength(); ++i)
        gram[(start + j) * m + first + i] = values[static_cast<Teuchos_Ordinal>(i)];
    }
  }
  sumOverRanks(*b.getRangeMap()->getComm(), std::span<double>(gram));
  return gram;
}

/// All of c on every rank.
std::vector<double> replicated(const RCP<const Vector>& c, std::size_t m, std::size_t first,
                               const Comm& comm) {
  std::vector<double> all(m, 0.0);
  if (!c.is_null())
    std::ranges::copy(localData(*c), all.begin() + static_cast<std::ptrdiff_t>(first));
  sumOverRanks(comm, std::span<double>(all));
  return all;
}

PreparedEquality orthonormal(const RCP<const Operator>& b, const RCP<const Vector>& c, std::size_t m) {
  const Map& rows = *b->getRangeMap();
  const Comm& comm = *rows.getComm();
  const std::size_t numLocalRows = Vector(b->getRangeMap()).getLocalLength();
  const std::size_t first = firstRow(rows, numLocalRows);
  std::vector<double> v = gramMatrix(*b, m, first), rhs = replicated(c, m, first, comm), scale(m),
                      eigenvalues(m);
  double frobeniusSquared = 0;
  for (std::size_t i = 0; i < m; ++i) {
    frobeniusSquared += v[i * m + i];
    scale[i] = v[i * m + i] > 0 ? 1.0 / std::sqrt(v[i * m + i]) : 0.0; // a zero row stays one
  }
  double emptyRows = 0; // what rows 0ᵀx = c_i ask for
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j)
      v[j * m + i] *= scale[i] * scale[j];
    if (scale[i] == 0)
      emptyRows = std::max(emptyRows, std::abs(rhs[i]));
  }
  int info = 0, n = static_cast<int>(m);
  std::vector<double> work(std::max<std::size_t>(1, 8 * m));
  Teuchos::LAPACK<int, double>().SYEV('V', 'L', n, v.data(), n, eigenvalues.data(), work.data(),
                                      static_cast<int>(work.size()), &info);
  if (info != 0)
    throw Error("the constraint matrix has entries that are not finite, or its Gram matrix has no "
                "eigenvalues to be found");

  PreparedEquality prepared;
  prepared.numRows = static_cast<GlobalOrdinal>(m);
  prepared.norm = std::sqrt(frobeniusSquared);
  double scaledSquared = 0;
  for (std::size_t i = 0; i < m; ++i)
    scaledSquared += scale[i] * scale[i] * rhs[i] * rhs[i];
  const double threshold = zeroEigenvalue * static_cast<double>(m) * std::max(eigenvalues.back(), 1.0);
  std::vector<double> contradiction(m, 0.0); // the part of the scaled c that no x gives
  std::vector<double> wc;
  std::vector<std::size_t> kept;
  double contradictionSquared = 0;
  for (std::size_t k = 0; k < m; ++k) {
    double share = 0; // Vᵀ D c
    for (std::size_t i = 0; i < m; ++i)
      share += v[k * m + i] * scale[i] * rhs[i];
    if (eigenvalues[k] > threshold) {
      kept.push_back(k);
      wc.push_back(share / std::sqrt(eigenvalues[k]));
      continue;
    }
    contradictionSquared += share * share;
    for (std::size_t i = 0; i < m; ++i)
      contradiction[i] += share * v[k * m + i] * scale[i];
  }
  prepared.rank = static_cast<GlobalOrdinal>(kept.size());
  if (emptyRows > 0) // 0ᵀx = c_i: the certificate is that row
    for (std::size_t i = 0; i < m; ++i)
      contradiction[i] = scale[i] == 0 ? rhs[i] : 0.0;
  if (emptyRows > 0 || contradictionSquared > zeroShare * zeroShare * scaledSquared) {
    double squared = 0;
    for (const double value : contradiction)
      squared += value * value;
    prepared.certificate = rcp(new Vector(b->getRangeMap()));
    const auto values = localDataNonConst(*prepared.certificate);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = -contradiction[first + i] / std::sqrt(squared);
    std::ostringstream text;
    text << "the equality constraints contradict each other: of " << m << " rows " << kept.size()
         << " are independent, and the right-hand side does not suit the others";
    prepared.contradiction = text.str();
  }
  std::vector<double> w(numLocalRows * kept.size());
  for (std::size_t i = 0; i < numLocalRows; ++i)
    for (std::size_t k = 0; k < kept.size(); ++k)
      w[i * kept.size() + k] =
          v[kept[k] * m + first + i] * scale[first + i] / std::sqrt(eigenvalues[kept[k]]);
  if (kept.empty())
    return prepared;
  const RCP<const OrthonormalEquality> constraint =
      rcp(new OrthonormalEquality(b, std::move(w), std::move(wc)));
  prepared.constraint = constraint;
  prepared.multiplierOfRows = [constraint, b](std::span<const double> mu) {
    const RCP<Vector> y = rcp(new Vector(b->getRangeMap()));
    constraint->combine(mu, *y);
    return y;
  };
  return prepared;
}

PreparedEquality scaled(const RCP<const Operator>& b, const RCP<const Vector>& c,
                        const NormEstimateParameters& norm) {
  PreparedEquality prepared;
  prepared.numRows = prepared.rank = static_cast<GlobalOrdinal>(b->getRangeMap()->getGlobalNumElements());
  const double squared = estimateNorm(GramOperator(b), norm).norm;
  if (squared == 0) {
    prepared.rank = 0;
    if (!c.is_null() && c->normInf() > 0) {
      prepared.contradiction =
          "the equality constraints contradict each other: B = 0, but the right-hand side is not";
      prepared.certificate = rcp(new Vector(*c, Teuchos::Copy));
      prepared.certificate->scale(-1.0 / c->norm2());
    }
    return prepared;
  }
  const double scale = 1.0 / std::sqrt(squared);
  prepared.norm = std::sqrt(squared);
  prepared.constraint = rcp(new ScaledEquality(b, c, scale));
  prepared.multiplierOfRows = [b, scale](std::span<const double> mu) {
    const RCP<Vector> y = rcp(new Vector(b->getRangeMap()));
    const auto values = localDataNonConst(*y);
    std::transform(mu.begin(), mu.end(), values.begin(), [scale](double value) { return scale * value; });
    return y;
  };
  return prepared;
}

} // namespace

PreparedEquality prepareEquality(const RCP<const Operator>& b, const RCP<const Vector>& c, int maxDenseRows,
                                 const NormEstimateParameters& norm) {
  if (!b->hasTransposeApply())
    throw InputError("the constraint operator has no transposed apply; SMALBE needs products with Bᵀ");
  if (!c.is_null() && !c->getMap()->isSameAs(*b->getRangeMap()))
    throw InputError(
        "the right-hand side of the equality constraints is not on the range map of their matrix");
  const auto m = static_cast<std::size_t>(b->getRangeMap()->getGlobalNumElements());
  if (m == 0)
    return {};
  return m <= static_cast<std::size_t>(maxDenseRows) ? orthonormal(b, c, m) : scaled(b, c, norm);
}

} // namespace epafi::qp
