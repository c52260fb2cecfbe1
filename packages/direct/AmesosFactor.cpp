#include "epafi/direct/AmesosFactor.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/base/Types.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Amesos2.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <utility>

namespace epafi::direct {
namespace {

using AmesosSolver = Amesos2::Solver<CrsMatrix, MultiVector>;

/// The matrix as Amesos2 wants it: a Tpetra matrix on a communicator of this rank alone. By symmetry the
/// columns of A are its rows.
RCP<CrsMatrix> toTpetra(const SparseMatrix& matrix) {
  const std::size_t n = matrix.rows();
  const RCP<const Comm> self = rcp(new Teuchos::SerialComm<int>());
  const RCP<const Map> map = rcp(new Map(n, 0, self, Tpetra::LocallyReplicated));

  const std::size_t nonZeros = matrix.nonZeros();
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
  AmesosFactor(const SparseMatrix& matrix, std::vector<int> kept, const std::string& solver)
      : size_(static_cast<int>(matrix.rows())), kept_(std::move(kept)), matrix_(toTpetra(matrix)),
        x_(matrix_->getDomainMap(), 1), b_(matrix_->getRangeMap(), 1) {
    solver_ = Amesos2::create<CrsMatrix, MultiVector>(solver, matrix_);
    solver_->symbolicFactorization();
    solver_->numericFactorization();
  }

  [[nodiscard]] int size() const override { return size_; }

  void solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x) override {
    const std::size_t numColumns = b.cols();
    if (numColumns == 0)
      return;
    if (b_.getNumVectors() != numColumns) {
      x_ = MultiVector(matrix_->getDomainMap(), numColumns);
      b_ = MultiVector(matrix_->getRangeMap(), numColumns);
    }
    for (std::size_t j = 0; j < numColumns; ++j)
      std::copy_n(b.col(j).data(), size_, b_.getDataNonConst(j).begin());
    solver_->solve(&x_, &b_);
    for (std::size_t j = 0; j < numColumns; ++j)
      std::copy_n(x_.getData(j).begin(), size_, x.col(j).data());
  }

  Eigen::MatrixXd schurComplement() override { return inverseOfSpd(inverseOfKept()); }

  /// Amesos2 shows no factors: a solve for each kept unknown, some at once.
  Eigen::MatrixXd inverseOfKept() override {
    constexpr Eigen::Index width = 32;
    const Eigen::Index k = kept_.size();
    Eigen::MatrixXd result(k, k);
    for (Eigen::Index first = 0; first < k; first += width) {
      const Eigen::Index columns = std::min(width, k - first);
      Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(size_, columns), image(size_, columns);
      for (Eigen::Index j = 0; j < columns; ++j)
        unit(kept_[first + j], j) = 1;
      solve(unit, image);
      result.middleCols(first, columns) = image(kept_, allOf);
    }
    return (0.5 * (result + result.transpose())).eval();
  }

  /// The Schur complement is made when it is first asked for, and kept.
  void multiplyKept(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> y) override {
    if (schur_.size() == 0)
      schur_ = schurComplement();
    y = (schur_ * x).eval();
  }
  void solveKept(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> x) override {
    whole_.setZero(size_, 1);
    image_.resize(size_, 1);
    whole_(kept_, 0) = b;
    solve(whole_, image_);
    x = image_(kept_, 0);
  }
  [[nodiscard]] std::size_t numKeptEntries() const override { return numEntries(); }

  [[nodiscard]] std::size_t bytes() const override { return numEntries() * (sizeof(double) + sizeof(int)); }
  [[nodiscard]] std::size_t numEntries() const override { return solver_->getStatus().getNnzLU(); }

private:
  int size_;
  std::vector<int> kept_;
  RCP<CrsMatrix> matrix_;
  MultiVector x_, b_;
  RCP<AmesosSolver> solver_;
  Eigen::MatrixXd schur_, whole_, image_; ///< S, once it was asked for; work
};

} // namespace

std::vector<std::string> amesosSolvers() {
  std::vector<std::string> names;
  for (const char* name : {"KLU2", "Basker", "SuperLU", "UMFPACK", "PARDISOMKL", "MUMPS"})
    if (Amesos2::query(name))
      names.emplace_back(name);
  return names;
}

std::unique_ptr<SpdFactor> factorizeByAmesos(const SparseMatrix& matrix, const std::vector<int>& kept,
                                             const std::string& solver) {
  return std::make_unique<AmesosFactor>(matrix, kept, solver);
}

} // namespace epafi::direct
