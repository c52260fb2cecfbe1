#pragma once

/// Sparse factorisation of a symmetric positive definite matrix that lies on one rank: one subdomain, or the
/// coarse problem; and the matrix condensed to some of its unknowns.

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace epafi::direct {

/// Symmetric matrix with both triangles stored.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// A factorised SPD matrix A (n × n), of whose unknowns k ≤ n are *kept*: eliminated last, so that what is
/// left of A when the others are gone, the Schur complement S = A_kk − A_ki A_ii⁻¹ A_ik = ((A⁻¹)_kk)⁻¹, can
/// be had. Not copyable; used by one rank alone, nothing here is collective.
class SpdFactor {
public:
  SpdFactor() = default;
  SpdFactor(const SpdFactor&) = delete;
  SpdFactor& operator=(const SpdFactor&) = delete;
  virtual ~SpdFactor() = default;

  [[nodiscard]] virtual int size() const = 0; ///< n
  /// X = A⁻¹ B; both n × m, column by column, m ≥ 0. X may not overlap B.
  virtual void solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x) = 0;
  /// S, k × k, in the order in which the kept unknowns were given; both triangles, equal to the last digit.
  virtual Eigen::MatrixXd schurComplement() = 0;
  /// (A⁻¹)_kk = S⁻¹, likewise.
  virtual Eigen::MatrixXd inverseOfKept() = 0;
  /// y = S x, without S: CHOLMOD reads its factor's last k columns, no others, twice. k entries each, in the
  /// same order; y may be x.
  virtual void multiplyKept(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> y) = 0;
  /// x = S⁻¹ b, likewise.
  virtual void solveKept(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> x) = 0;
  /// Bytes that the factors take.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
  /// Entries of the factor: a solve reads each of them twice.
  [[nodiscard]] virtual std::size_t numEntries() const = 0;
  /// Those that solveKept reads, likewise.
  [[nodiscard]] virtual std::size_t numKeptEntries() const = 0;
};

/// Ordering and elimination tree of a pattern (CholmodFactor.hpp).
class CholmodPattern;

/// Factorises matrices by one direct solver, and remembers what depends on their pattern alone (ordering,
/// elimination tree) for the next one with the same pattern and the same unknowns kept.
class Factorizer {
public:
  /// \param solver  one of `availableSolvers()`. \throws InputError for another name (lists the known ones),
  ///        std::bad_alloc if the BLAS cannot have the memory that it takes for itself.
  explicit Factorizer(std::string solver);

  /// Precondition: A square, SPD, both triangles stored; `kept` distinct and within it. n = 0 is allowed.
  /// \param like  an earlier factor, of any Factorizer: what depends on its pattern alone is used again if it
  /// is the same and CHOLMOD made both; or null
  /// \throws Error if the factorisation fails, with `what` (the matrix's name for people, such as "subdomain
  /// 3") and n.
  std::unique_ptr<SpdFactor> factorize(const SparseMatrix& matrix, const std::vector<int>& kept,
                                       const std::string& what, const SpdFactor* like = nullptr);

  [[nodiscard]] const std::string& solver() const { return solver_; } ///< its name
  /// Symbolic factorisations made so far: the number of different patterns, where the solver shares them.
  [[nodiscard]] int numSymbolic() const { return numSymbolic_; }

private:
  std::string solver_;
  /// The last ones met, the latest first: subdomains of one kind follow each other.
  std::vector<std::shared_ptr<const CholmodPattern>> patterns_;
  int numSymbolic_ = 0;
};

/// Names that `Factorizer` takes: CHOLMOD, and the serial solvers of Amesos2 in this build of Trilinos.
/// Amesos2's Tacho is left out: it crashes on matrices of some thousand unknowns in Trilinos 13.2.
std::vector<std::string> availableSolvers();

/// The solver that was fastest at every size measured (docs/performance.md).
std::string fastestSolver();

/// Factorises one matrix of which nothing is kept. See Factorizer.
std::unique_ptr<SpdFactor> factorize(const SparseMatrix& matrix, const std::string& solver,
                                     const std::string& what);

} // namespace epafi::direct
