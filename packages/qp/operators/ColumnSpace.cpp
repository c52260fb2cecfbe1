#include "epafi/qp/operators/ColumnSpace.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace epafi::qp {
ColumnSpace::ColumnSpace(RCP<const Map> map) : map_(std::move(map)), numRows_(numLocal(*map_)) {}

std::span<const double> ColumnSpace::image(std::size_t k) const {
  return std::span(image_).subspan(k * numRows_, numRows_);
}

void ColumnSpace::add(const Operator& a, const MultiVector& columns) {
  MultiVector images(map_, columns.getNumVectors());
  a.apply(columns, images);
  for (std::size_t k = 0; k < columns.getNumVectors(); ++k) {
    const std::span<const double> values = localColumn(columns, k), products = localColumn(images, k);
    for (std::size_t row = 0; row < values.size(); ++row)
      if (values[row] != 0)
        entries_.push_back({row, values[row]});
    columnBegin_.push_back(entries_.size());
    image_.insert(image_.end(), products.begin(), products.end());
  }
}

bool ColumnSpace::factorize() {
  const std::size_t k = size();
  constexpr std::size_t batch = 32; // columns in a message
  factor_.resize(k * k);
  for (std::size_t first = 0; first < k; first += batch) {
    const std::size_t last = std::min(k, first + batch);
    sums_.assign((last - first) * k, AccurateSum());
    for (std::size_t j = first; j < last; ++j)
      for (std::size_t i = 0; i < k; ++i)
        for (const Entry& entry : column(i))
          sums_[(j - first) * k + i].add(entry.value * image(j)[entry.row]);
    sumOverRanks(*map_->getComm(), sums_, factor_.data() + first * k);
  }
  scale_.resize(k);
  for (std::size_t i = 0; i < k; ++i) {
    if (!(factor_[i * k + i] > 0 && std::isfinite(factor_[i * k + i])))
      return false;
    scale_[i] = 1 / std::sqrt(factor_[i * k + i]);
  }
  for (std::size_t j = 0; j < k; ++j) // the lower triangle is all that LAPACK reads
    for (std::size_t i = j; i < k; ++i)
      factor_[j * k + i] = scale_[i] * scale_[j] * 0.5 * (factor_[j * k + i] + factor_[i * k + j]);
  int info = 0;
  if (k > 0)
    Teuchos::LAPACK<int, double>().POTRF('L', size(), factor_.data(), size(), &info);
  bool isDefinite = info == 0;
  for (std::size_t i = 0; i < k && isDefinite; ++i) // beside the unit diagonal a pivot like that is round-off
    isDefinite = factor_[i * k + i] * factor_[i * k + i] >
                 static_cast<double>(k) * std::numeric_limits<double>::epsilon();
  return isDefinite;
}

/// c = (UᵀAU)⁻¹ times the sums over the ranks.
void ColumnSpace::solve(Coefficients& c) const {
  const std::size_t k = size();
  sumOverRanks(*map_->getComm(), sums_);
  c.resize(sums_.size());
  for (std::size_t i = 0; i < c.size(); ++i)
    c[i] = sums_[i].value() * scale_[i % k];
  int info = 0;
  if (!c.empty())
    Teuchos::LAPACK<int, double>().POTRS('L', size(), static_cast<int>(c.size() / k), factor_.data(), size(),
                                         c.data(), size(), &info);
  for (std::size_t i = 0; i < c.size(); ++i)
    c[i] *= scale_[i % k];
}

void ColumnSpace::coefficients(const MultiVector& d, Coefficients& c) const {
  const std::size_t k = size();
  sums_.assign(k * d.getNumVectors(), AccurateSum());
  for (std::size_t j = 0; j < d.getNumVectors(); ++j) {
    const std::span<const double> values = localColumn(d, j);
    for (std::size_t i = 0; i < k; ++i)
      for (const Entry& entry : column(i))
        sums_[j * k + i].add(entry.value * values[entry.row]);
  }
  solve(c);
}

void ColumnSpace::imageCoefficients(const MultiVector& x, Coefficients& c) const {
  const std::size_t k = size();
  sums_.assign(k * x.getNumVectors(), AccurateSum());
  for (std::size_t j = 0; j < x.getNumVectors(); ++j) {
    const std::span<const double> values = localColumn(x, j);
    for (std::size_t i = 0; i < k; ++i) {
      const std::span<const double> images = image(i);
      for (std::size_t row = 0; row < values.size(); ++row)
        sums_[j * k + i].add(images[row] * values[row]);
    }
  }
  solve(c);
}

void ColumnSpace::addColumns(const Coefficients& c, MultiVector& x) const {
  const std::size_t k = size();
  for (std::size_t j = 0; j < x.getNumVectors(); ++j) {
    const std::span<double> values = localColumnNonConst(x, j);
    for (std::size_t i = 0; i < k; ++i)
      for (const Entry& entry : column(i))
        values[entry.row] += entry.value * c[j * k + i];
  }
}

/// Entry by entry in the same order whatever the number of rows, so that ranks do not matter.
void ColumnSpace::subtractImage(const Coefficients& c, MultiVector& y) const {
  const std::size_t k = size();
  for (std::size_t j = 0; j < y.getNumVectors(); ++j) {
    const std::span<double> values = localColumnNonConst(y, j);
    const double* const factors = c.data() + j * k;
    std::size_t i = 0;
    for (; i + 4 <= k; i += 4) { // four columns a pass over y
      const double *const a0 = image(i).data(), *const a1 = image(i + 1).data(),
                          *const a2 = image(i + 2).data(), *const a3 = image(i + 3).data();
      for (std::size_t row = 0; row < values.size(); ++row)
        values[row] -= (a0[row] * factors[i] + a1[row] * factors[i + 1]) +
                       (a2[row] * factors[i + 2] + a3[row] * factors[i + 3]);
    }
    for (; i < k; ++i)
      for (std::size_t row = 0; row < values.size(); ++row)
        values[row] -= image(i)[row] * factors[i];
  }
}

void ColumnSpace::project(MultiVector& x) const {
  imageCoefficients(x, coefficients_);
  for (double& c : coefficients_)
    c = -c;
  addColumns(coefficients_, x);
}

void ColumnSpace::projectTransposed(MultiVector& d) const {
  coefficients(d, coefficients_);
  subtractImage(coefficients_, d);
}

void ColumnSpace::correct(const MultiVector& d, MultiVector& x) const {
  coefficients(d, coefficients_);
  addColumns(coefficients_, x);
}

std::size_t ColumnSpace::bytes() const {
  return image_.size() * sizeof(double) + entries_.size() * sizeof(Entry);
}

} // namespace epafi::qp
