#include "epafi/fetidp/operator/CondensedSubdomain.hpp"

#include "epafi/base/EigenCompatibility.hpp"

#include <utility>

namespace epafi::fetidp {

using decomposition::SparseMatrix;

SparseMatrix block(const SparseMatrix& matrix, const std::vector<int>& rows,
                   const std::vector<int>& columns) {
  std::vector<int> position(matrix.rows(), -1);
  for (int i = 0; i < std::ssize(rows); ++i)
    position[rows[i]] = i;
  SparseMatrix result(rows.size(), columns.size());
  Eigen::Index numEntries = 0;
  for (const int column : columns)
    numEntries += matrix.outerIndexPtr()[column + 1] - matrix.outerIndexPtr()[column];
  result.reserve(numEntries);
  for (int j = 0; j < std::ssize(columns); ++j) {
    result.startVec(j);
    for (SparseMatrix::InnerIterator entry(matrix, columns[j]); entry; ++entry) {
      const int row = position[entry.row()];
      if (row >= 0)
        result.insertBack(row, j) = entry.value();
    }
  }
  result.finalize();
  return result;
}

CondensedSubdomain::CondensedSubdomain(const decomposition::Subdomain& subdomain,
                                       SubdomainInterface interface, bool isShared,
                                       direct::Factorizer& factorizer, const direct::SpdFactor* like)
    : interface_(std::move(interface)) {
  const auto& remainder = subdomain.remainderUnknowns;
  const auto& crosspoints = subdomain.crosspointUnknowns;
  factor_ = factorizer.factorize(block(*subdomain.stiffness, remainder, remainder), interface_.boundary,
                                 "subdomain " + std::to_string(subdomain.number), like);
  remainderToCrosspoint_ = block(*subdomain.stiffness, remainder, crosspoints);

  const Eigen::MatrixXd rhs(remainderToCrosspoint_);
  Eigen::MatrixXd response(rhs.rows(), rhs.cols());
  factor_->solve(rhs, response); // Ψ = K_rr⁻¹ K_rc
  boundaryResponse_ = response(interface_.boundary, allOf);
  schurComplement_ = Eigen::MatrixXd(block(*subdomain.stiffness, crosspoints, crosspoints));
  schurComplement_ -= remainderToCrosspoint_.transpose() * response; // S = K_cc − K_cr Ψ
  schurComplement_ =
      (0.5 * (schurComplement_ + schurComplement_.transpose())).eval(); // symmetric to the last digit
  if (isShared)
    crosspointResponse_ = std::move(response);
}

} // namespace epafi::fetidp
