#include "epafi/direct/LastBlock.hpp"

#include <Teuchos_BLAS.hpp>
#include <cholmod.h>

#include <algorithm>
#include <ranges>

// Teuchos has these for several columns only. NOLINTBEGIN(readability-identifier-naming)
extern "C" void dtrsv_(const char* uplo, const char* trans, const char* diag, const int* n, const double* a,
                       const int* lda, double* x, const int* incx);
extern "C" void dtrmv_(const char* uplo, const char* trans, const char* diag, const int* n, const double* a,
                       const int* lda, double* x, const int* incx);
// NOLINTEND(readability-identifier-naming)

namespace epafi::direct {
LastBlock::LastBlock(const cholmod_factor_struct& factor, int k) : offset_(static_cast<int>(factor.n) - k) {
  const auto* values = static_cast<const double*>(factor.x);
  if (factor.is_super == 0) {
    const auto *start = static_cast<const int*>(factor.p), *rows = static_cast<const int*>(factor.i),
               *count = static_cast<const int*>(factor.nz);
    for (int column = offset_; column < offset_ + k; ++column)
      addPanel(rows + start[column], count[column], 1, values + start[column]);
  } else {
    const auto *super = static_cast<const int*>(factor.super), *pi = static_cast<const int*>(factor.pi),
               *px = static_cast<const int*>(factor.px), *rows = static_cast<const int*>(factor.s);
    for (std::size_t s = 0; s < factor.nsuper; ++s)
      if (super[s + 1] > offset_)
        addPanel(rows + pi[s], pi[s + 1] - pi[s], super[s + 1] - super[s], values + px[s]);
  }
  int largest = 0;
  for (const Panel& panel : panels_)
    largest = std::max(largest, panel.numBelow);
  below_.resize(largest);
}

/// Columns before the k are left out.
void LastBlock::addPanel(const int* rows, int numRows, int width, const double* values) {
  const int skipped = std::max(0, offset_ - rows[0]);
  const int kept = width - skipped;
  panels_.push_back({rows[0] + skipped - offset_, kept, rows + width, numRows - width,
                     values + skipped + std::ptrdiff_t{skipped} * numRows, numRows});
}

Eigen::MatrixXd LastBlock::dense() const {
  const Eigen::Index k = panels_.empty() ? 0 : panels_.back().first + panels_.back().width;
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(k, k);
  for (const Panel& panel : panels_)
    for (int j = 0; j < panel.width; ++j) {
      const double* column = panel.values + std::ptrdiff_t{j} * panel.stride;
      for (int i = j; i < panel.width; ++i)
        c(panel.first + i, panel.first + j) = column[i];
      for (int i = 0; i < panel.numBelow; ++i)
        c(panel.below[i] - offset_, panel.first + j) = column[panel.width + i];
    }
  return c;
}

/// x_own = T⁻¹ x_own or T⁻ᵀ x_own, T the panel's triangle.
void LastBlock::solveTriangle(const char* transposed, const Panel& panel, double* x) {
  constexpr int step = 1;
  if (panel.width == 1)
    x[panel.first] /= *panel.values;
  else
    dtrsv_("L", transposed, "N", &panel.width, panel.values, &panel.stride, x + panel.first, &step);
}

/// x_own = T x_own or Tᵀ x_own.
void LastBlock::multiplyTriangle(const char* transposed, const Panel& panel, double* x) {
  constexpr int step = 1;
  if (panel.width == 1)
    x[panel.first] *= *panel.values;
  else
    dtrmv_("L", transposed, "N", &panel.width, panel.values, &panel.stride, x + panel.first, &step);
}

/// x_below += factor · V x_own of the rows under the panel's triangle.
void LastBlock::addBelow(const Panel& panel, double factor, double* x) const {
  const double *values = panel.values + panel.width, *own = x + panel.first;
  if (panel.width == 1) { // of a simplicial factor: too small for a call
    const double scaled = factor * *own;
    for (int i = 0; i < panel.numBelow; ++i)
      x[panel.below[i] - offset_] += scaled * values[i];
    return;
  }
  if (panel.numBelow == 0)
    return;
  Teuchos::BLAS<int, double>().GEMV(Teuchos::NO_TRANS, panel.numBelow, panel.width, factor, values,
                                    panel.stride, own, 1, 0.0, below_.data(), 1);
  for (int i = 0; i < panel.numBelow; ++i)
    x[panel.below[i] - offset_] += below_[i];
}

/// x_own += factor · Vᵀ x_below.
void LastBlock::addFromBelow(const Panel& panel, double factor, double* x) const {
  const double* values = panel.values + panel.width;
  double* own = x + panel.first;
  if (panel.width == 1) {
    double sum = 0;
    for (int i = 0; i < panel.numBelow; ++i)
      sum += values[i] * x[panel.below[i] - offset_];
    *own += factor * sum;
    return;
  }
  if (panel.numBelow == 0)
    return;
  for (int i = 0; i < panel.numBelow; ++i)
    below_[i] = x[panel.below[i] - offset_];
  Teuchos::BLAS<int, double>().GEMV(Teuchos::TRANS, panel.numBelow, panel.width, factor, values, panel.stride,
                                    below_.data(), 1, 1.0, own, 1);
}

void LastBlock::solve(double* x) const {
  for (const Panel& panel : panels_) { // C y = x
    solveTriangle("N", panel, x);
    addBelow(panel, -1, x);
  }
  for (const Panel& panel : std::views::reverse(panels_)) { // Cᵀ x = y
    addFromBelow(panel, -1, x);
    solveTriangle("T", panel, x);
  }
}

void LastBlock::multiply(double* x) const {
  for (const Panel& panel : panels_) { // y = Cᵀ x
    multiplyTriangle("T", panel, x);
    addFromBelow(panel, 1, x);
  }
  for (const Panel& panel : std::views::reverse(panels_)) { // x = C y
    addBelow(panel, 1, x);
    multiplyTriangle("N", panel, x);
  }
}

std::size_t LastBlock::numEntries() const {
  std::size_t entries = 0;
  for (const Panel& panel : panels_) {
    const std::size_t width = panel.width;
    entries += width * (width + 1) / 2 + width * panel.numBelow;
  }
  return entries;
}

} // namespace epafi::direct
