#pragma once

/// The space of a few columns U beside a symmetric operator A: what deflation, projector preconditioning and
/// coarse corrections compute with. With
///   P = I − U(UᵀAU)⁻¹UᵀA
/// x = Px + U(UᵀAU)⁻¹UᵀAx: the second part is what U can do for a solution of Ax = b, and costs no iteration.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Types.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace epafi::qp {

/// n × k. Entries of U that are 0 are not kept. Memory: AU, n k numbers shared by the ranks, and k² on every
/// rank. A rank may have no rows. All results are the same on any number of ranks.
class ColumnSpace {
public:
  /// k × (number of right-hand sides), column after column, on every rank.
  using Coefficients = std::vector<double>;

  /// Without columns. \param map  the n rows
  explicit ColumnSpace(RCP<const Map> map);

  /// Further columns and what A makes of them, both on the map. One product with A for each, all in one pass.
  /// Collective.
  void add(const Operator& a, const MultiVector& columns);
  /// The factor of UᵀAU, after the last `add` and before all that follows. Whether UᵀAU is positive definite,
  /// on all ranks alike. Collective.
  [[nodiscard]] bool factorize();

  /// k.
  [[nodiscard]] int size() const { return static_cast<int>(columnBegin_.size()) - 1; }
  [[nodiscard]] const RCP<const Map>& map() const { return map_; } ///< of the n rows

  /// c = (UᵀAU)⁻¹Uᵀd. One message of k numbers a column of d. Collective.
  void coefficients(const MultiVector& d, Coefficients& c) const;
  /// c = (UᵀAU)⁻¹UᵀAx, likewise.
  void imageCoefficients(const MultiVector& x, Coefficients& c) const;
  /// x += U c. Not collective.
  void addColumns(const Coefficients& c, MultiVector& x) const;
  /// y −= AU c. Not collective.
  void subtractImage(const Coefficients& c, MultiVector& y) const;

  /// x ← Px. Collective.
  void project(MultiVector& x) const;
  /// d ← Pᵀd = d − AU(UᵀAU)⁻¹Uᵀd. Collective.
  void projectTransposed(MultiVector& d) const;
  /// x += U(UᵀAU)⁻¹Uᵀd. Collective.
  void correct(const MultiVector& d, MultiVector& x) const;

  /// Of this rank's part of U and AU.
  [[nodiscard]] std::size_t bytes() const;

private:
  struct Entry {
    std::size_t row; ///< local index
    double value;
  };
  [[nodiscard]] std::span<const Entry> column(std::size_t k) const {
    return std::span(entries_).subspan(columnBegin_[k], columnBegin_[k + 1] - columnBegin_[k]);
  }
  [[nodiscard]] std::span<const double> image(std::size_t k) const;
  void solve(Coefficients& c) const;

  RCP<const Map> map_;
  std::size_t numRows_; ///< of this rank
  std::vector<Entry> entries_;
  std::vector<std::size_t> columnBegin_{0}; ///< in the entries
  std::vector<double> image_;               ///< AU, this rank's rows, column after column
  std::vector<double> scale_;               ///< D = diag(UᵀAU)^(−1/2)
  std::vector<double> factor_;              ///< Cholesky's, of D UᵀAU D
  mutable std::vector<AccurateSum> sums_;   ///< work
  mutable Coefficients coefficients_;       ///< of `project` and its like
};

} // namespace epafi::qp
