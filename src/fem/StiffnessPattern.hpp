#pragma once

/// Where the entries of a subdomain's stiffness are, found once for all subdomains of one kind.

#include "epafi/fem/LocalNumbering.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <memory>
#include <span>
#include <vector>

namespace epafi::fem {

/// Sparsity of K for a numbering and its free positions, and the place of every element's entries in it.
class StiffnessPattern {
public:
  /// \param unknownOf  unknown at each position (node × components + component), −1 where supported; unknowns
  /// are numbered in the order of their positions
  StiffnessPattern(std::shared_ptr<const LocalNumbering> numbering, int components,
                   std::vector<int> unknownOf);

  /// Whether it is the pattern for these.
  [[nodiscard]] bool fits(const LocalNumbering& numbering, const std::vector<int>& unknownOf) const {
    return numbering_.get() == &numbering && unknownOf_ == unknownOf;
  }

  /// Gives K its pattern; all values are 0.
  void shape(Eigen::SparseMatrix<double, Eigen::ColMajor, int>& stiffness) const;

  /// Place in K's values of each entry of an element's matrix, column by column; −1 where one of the two
  /// values is supported.
  [[nodiscard]] std::span<const int> places(std::size_t element) const {
    const std::size_t number = valuesPerElement_ * valuesPerElement_;
    return std::span(places_).subspan(element * number, number);
  }

  /// Elements with supported values, ascending.
  [[nodiscard]] std::span<const std::size_t> supportedElements() const { return supportedElements_; }

private:
  class NodeColumn;
  void findSupportedElements();
  /// Appends the column of one component of the node that the `corners` share.
  void addColumn(const NodeColumn& column, std::span<const int> corners, std::size_t component);

  std::shared_ptr<const LocalNumbering> numbering_;
  std::size_t components_, valuesPerElement_;
  std::vector<int> unknownOf_;
  std::vector<int> columnStart_, rows_; ///< K in compressed columns
  std::vector<int> places_;
  std::vector<std::size_t> supportedElements_;
};

} // namespace epafi::fem
