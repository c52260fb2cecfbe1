#pragma once

/// Sparse factorisation of a symmetric positive definite matrix that lies on one rank: one subdomain, or the
/// coarse problem.

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace epafi::direct {

/// Symmetric matrix with both triangles stored.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// A factorised SPD matrix A (n × n). Not copyable; used by one rank alone, nothing here is collective.
class SpdFactor {
public:
  virtual ~SpdFactor() = default;
  SpdFactor(const SpdFactor&) = delete;
  SpdFactor& operator=(const SpdFactor&) = delete;
  SpdFactor(SpdFactor&&) = delete;
  SpdFactor& operator=(SpdFactor&&) = delete;

  [[nodiscard]] virtual int size() const = 0;
  /// X = A⁻¹ B; both n × k, column by column, k ≥ 0. X may not overlap B.
  virtual void solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x) = 0;
  /// Bytes that the factors take.
  [[nodiscard]] virtual std::size_t bytes() const = 0;

protected:
  SpdFactor() = default;
};

/// Names that `factorize` takes with this build of Trilinos. Amesos2's Tacho is left out: it crashes on
/// matrices of some thousand unknowns in Trilinos 13.2.
std::vector<std::string> availableSolvers();

/// Factorises A by the Amesos2 solver called `solver`.
/// Precondition: A square, SPD, both triangles stored. n = 0 is allowed.
/// \throws InputError for an unknown name (lists the known ones); Error if the factorisation fails, with
///         `what` (the matrix's name for people, such as "subdomain 3") and n.
std::unique_ptr<SpdFactor> factorize(const SparseMatrix& matrix, const std::string& solver,
                                     const std::string& what);

} // namespace epafi::direct
