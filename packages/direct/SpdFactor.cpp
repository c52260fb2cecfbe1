#include "epafi/direct/SpdFactor.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Types.hpp"

#include <Amesos2.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>

namespace epafi::direct {
namespace {

using AmesosSolver = Amesos2::Solver<CrsMatrix, MultiVector>;

/// The matrix as Amesos2 wants it: a Tpetra matrix on a communicator of this rank alone. By symmetry the
/// columns of A are its rows.
RCP<CrsMatrix> toTpetra(const SparseMatrix& matrix) {
  const auto n = static_cast<std::size_t>(matrix.rows());
  const RCP<const Comm> self = rcp(new Teuchos::SerialComm<int>());
  const RCP<const Map> map = rcp(new Map(n, 0, self, Tpetra::LocallyReplicated));

  const auto nonZeros = static_cast<std::size_t>(matrix.nonZeros());
  Teuchos::ArrayRCP<std::size_t> rowStart(n + 1);
  Teuchos::ArrayRCP<LocalOrdinal> columns(static_cast<Teuchos::ArrayRCP<LocalOrdinal>::size_type>(nonZeros));
  Teuchos::ArrayRCP<double> values(static_cast<Teuchos::ArrayRCP<double>::size_type>(nonZeros));
  std::copy_n(matrix.outerIndexPtr(), n + 1, rowStart.begin());
  std::copy_n(matrix.innerIndexPtr(), nonZeros, columns.begin());
  std::copy_n(matrix.valuePtr(), nonZeros, values.begin());

  const RCP<CrsMatrix> result = rcp(new CrsMatrix(map, map, rowStart, columns, values));
  result->fillComplete(map, map);
  return result;
}

class AmesosFactor final : public SpdFactor {
public:
  AmesosFactor(const SparseMatrix& matrix, const std::string& solver)
      : size_(static_cast<int>(matrix.rows())), matrix_(toTpetra(matrix)), x_(matrix_->getDomainMap(), 1),
        b_(matrix_->getRangeMap(), 1) {
    solver_ = Amesos2::create<CrsMatrix, MultiVector>(solver, matrix_);
    solver_->symbolicFactorization();
    solver_->numericFactorization();
  }

  [[nodiscard]] int size() const override { return size_; }

  void solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x) override {
    const auto numColumns = static_cast<std::size_t>(b.cols());
    if (numColumns == 0)
      return;
    if (b_.getNumVectors() != numColumns) {
      x_ = MultiVector(matrix_->getDomainMap(), numColumns);
      b_ = MultiVector(matrix_->getRangeMap(), numColumns);
    }
    for (std::size_t j = 0; j < numColumns; ++j)
      std::copy_n(b.col(static_cast<Eigen::Index>(j)).data(), size_, b_.getDataNonConst(j).begin());
    solver_->solve(&x_, &b_);
    for (std::size_t j = 0; j < numColumns; ++j)
      std::copy_n(x_.getData(j).begin(), size_, x.col(static_cast<Eigen::Index>(j)).data());
  }

  [[nodiscard]] std::size_t bytes() const override {
    return solver_->getStatus().getNnzLU() * (sizeof(double) + sizeof(int));
  }

private:
  int size_;
  RCP<CrsMatrix> matrix_;
  MultiVector x_, b_;
  RCP<AmesosSolver> solver_;
};

/// The factor of a matrix without rows.
class EmptyFactor final : public SpdFactor {
public:
  [[nodiscard]] int size() const override { return 0; }
  void solve(const Eigen::Ref<const Eigen::MatrixXd>&, Eigen::Ref<Eigen::MatrixXd>) override {}
  [[nodiscard]] std::size_t bytes() const override { return 0; }
};

} // namespace

std::vector<std::string> availableSolvers() {
  std::vector<std::string> names;
  for (const char* name : {"KLU2", "Basker", "CHOLMOD", "SuperLU", "UMFPACK", "PARDISOMKL", "MUMPS"})
    if (Amesos2::query(name))
      names.emplace_back(name);
  return names;
}

std::unique_ptr<SpdFactor> factorize(const SparseMatrix& matrix, const std::string& solver,
                                     const std::string& what) {
  const std::vector<std::string> names = availableSolvers();
  if (std::find(names.begin(), names.end(), solver) == names.end()) {
    std::string known;
    for (const std::string& name : names)
      known += (known.empty() ? "" : ", ") + name;
    throw InputError("the direct solver '" + solver +
                     "' is not known to this build of Trilinos; use one of: " + known);
  }
  if (matrix.rows() == 0)
    return std::make_unique<EmptyFactor>();
  try {
    return std::make_unique<AmesosFactor>(matrix, solver);
  } catch (const std::exception& error) {
    throw Error("the matrix of " + what + " (" + std::to_string(matrix.rows()) +
                " unknowns) could not be factorised by " + solver + ": " + error.what());
  }
}

} // namespace epafi::direct
