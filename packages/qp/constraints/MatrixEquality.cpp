#include "epafi/qp/constraints/MatrixEquality.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Columns.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/qp/constraints/EqualityRows.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace epafi::qp {
namespace {

/// Eigenvalues of BBᵀ (rows of length 1) below this belong to redundant rows.
constexpr double zeroEigenvalue = 1e-14;
/// A right-hand side that the rows cannot give is a contradiction if its share is larger than this.
constexpr double zeroShare = 1e-9;

/// BBᵀ, for its norm.
class GramOperator final : public SymmetricOperator {
public:
  explicit GramOperator(RCP<const Operator> b)
      : SymmetricOperator(b->getRangeMap()), b_(std::move(b)), transposed_(b_->getDomainMap()) {}

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      b_->apply(in, transposed_, Teuchos::TRANS);
      b_->apply(transposed_, out);
    });
  }

  RCP<const Operator> b_;
  mutable Vector transposed_;
};

/// The rows of B numbered from 0 over the ranks: the number of this rank's first one.
std::size_t firstRow(const Map& rows, std::size_t numLocalRows) {
  return static_cast<std::size_t>(sumBefore(*rows.getComm(), static_cast<GlobalOrdinal>(numLocalRows)));
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

/// DBBᵀD = VΛVᵀ, where D makes the rows of B of length 1; m × m on every rank.
struct RowSpectrum {
  std::vector<double> scale;       ///< D; 0 for an empty row, which stays one
  std::vector<double> vectors;     ///< V, column after column
  std::vector<double> eigenvalues; ///< Λ, ascending
  std::size_t numRedundant = 0;    ///< of them that are 0 but for round-off, the first ones
  double frobeniusNorm = 0;        ///< of B

  /// Entry i of Dv_k.
  [[nodiscard]] double entry(std::size_t i, std::size_t k) const {
    return vectors[k * scale.size() + i] * scale[i];
  }
  /// v_kᵀDc.
  [[nodiscard]] double share(std::size_t k, std::span<const double> c) const {
    double sum = 0;
    for (std::size_t i = 0; i < c.size(); ++i)
      sum += entry(i, k) * c[i];
    return sum;
  }
};

/// \param gram  BBᵀ
RowSpectrum spectrumOfRows(std::vector<double> gram, std::size_t m) {
  RowSpectrum rows{std::vector<double>(m), std::move(gram), std::vector<double>(m)};
  double frobeniusSquared = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const double squared = rows.vectors[i * m + i];
    frobeniusSquared += squared;
    rows.scale[i] = squared > 0 ? 1.0 / std::sqrt(squared) : 0.0;
  }
  rows.frobeniusNorm = std::sqrt(frobeniusSquared);
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t j = 0; j < m; ++j)
      rows.vectors[j * m + i] *= rows.scale[i] * rows.scale[j];
  int info = 0;
  const int n = static_cast<int>(m);
  std::vector<double> work(8 * m);
  Teuchos::LAPACK<int, double>().SYEV('V', 'L', n, rows.vectors.data(), n, rows.eigenvalues.data(),
                                      work.data(), static_cast<int>(work.size()), &info);
  if (info != 0)
    throw Error("the constraint matrix has entries that are not finite, or its Gram matrix has no "
                "eigenvalues to be found");
  const double threshold = zeroEigenvalue * static_cast<double>(m) * std::max(rows.eigenvalues.back(), 1.0);
  while (rows.numRedundant < m && !(rows.eigenvalues[rows.numRedundant] > threshold))
    ++rows.numRedundant;
  return rows;
}

double normOf(std::span<const double> values) {
  double squared = 0;
  for (const double value : values)
    squared += value * value;
  return std::sqrt(squared);
}

/// The part of c that no x gives, on every row; empty if there is none but round-off.
std::vector<double> unreachable(const RowSpectrum& rows, std::span<const double> c) {
  const std::size_t m = c.size();
  std::vector<double> empty(m, 0.0), scaled(m),
      left(m, 0.0); // what rows 0ᵀx = c_i ask for; Dc; of that, what is left
  for (std::size_t i = 0; i < m; ++i) {
    scaled[i] = rows.scale[i] * c[i];
    if (rows.scale[i] == 0)
      empty[i] = c[i];
  }
  if (normOf(empty) > 0)
    return empty;
  double leftSquared = 0;
  for (std::size_t k = 0; k < rows.numRedundant; ++k) {
    const double share = rows.share(k, c);
    leftSquared += share * share;
    for (std::size_t i = 0; i < m; ++i)
      left[i] += share * rows.entry(i, k);
  }
  if (std::sqrt(leftSquared) > zeroShare * normOf(scaled))
    return left;
  return {};
}

PreparedEquality orthonormal(const RCP<const Operator>& b, const RCP<const Vector>& c, std::size_t m) {
  const std::size_t numLocalRows = numLocal(*b->getRangeMap());
  const std::size_t first = firstRow(*b->getRangeMap(), numLocalRows);
  const RowSpectrum rows = spectrumOfRows(gramMatrix(*b, m, first), m);
  const std::vector<double> rhs =
      c.is_null() ? std::vector<double>(m, 0.0) : gatherOnAll(*b->getRangeMap()->getComm(), localData(*c));
  const std::size_t rank = m - rows.numRedundant;

  PreparedEquality prepared;
  prepared.numRows = static_cast<GlobalOrdinal>(m);
  prepared.rank = static_cast<GlobalOrdinal>(rank);
  prepared.norm = rows.frobeniusNorm;
  if (const std::vector<double> left = unreachable(rows, rhs); !left.empty()) {
    prepared.certificate = rcp(new Vector(b->getRangeMap()));
    const auto values = localDataNonConst(*prepared.certificate);
    const double length = normOf(left);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = -left[first + i] / length;
    prepared.contradiction = "the equality constraints contradict each other: of " + std::to_string(m) +
                             " rows " + std::to_string(rank) +
                             " are independent, and the right-hand side does not suit the others";
  }
  if (rank == 0)
    return prepared;
  std::vector<double> w(numLocalRows * rank), wc(rank); // W = Λ^(−1/2) VᵀD, without the redundant rows
  for (std::size_t k = 0; k < rank; ++k) {
    const double root = std::sqrt(rows.eigenvalues[rows.numRedundant + k]);
    wc[k] = rows.share(rows.numRedundant + k, rhs) / root;
    for (std::size_t i = 0; i < numLocalRows; ++i)
      w[i * rank + k] = rows.entry(first + i, rows.numRedundant + k) / root;
  }
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
  const std::size_t m = b->getRangeMap()->getGlobalNumElements();
  if (m == 0)
    return {};
  return m <= static_cast<std::size_t>(maxDenseRows) ? orthonormal(b, c, m) : scaled(b, c, norm);
}

} // namespace epafi::qp
