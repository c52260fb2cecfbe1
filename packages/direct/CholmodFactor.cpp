#include "epafi/direct/CholmodFactor.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/direct/LastBlock.hpp"

#include <cholmod.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

// OpenMP's own header is the compiler's, and not every tool that reads this file has it.
extern "C" int omp_get_max_active_levels();            // NOLINT(readability-identifier-naming)
extern "C" void omp_set_max_active_levels(int levels); // NOLINT(readability-identifier-naming)

namespace epafi::direct {
namespace {

/// While it lives, OpenMP makes no threads for this one. CHOLMOD asks for four whatever the machine has,
/// ranks are what Epafi runs in parallel, and on matrices of some hundred unknowns the threads cost more than
/// they bring.
class OneThread {
public:
  OneThread() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;
  ~OneThread() { omp_set_max_active_levels(levels_); }

private:
  int levels_;
};

/// CHOLMOD's settings and work space, one for the process; never freed before its last factor.
class Workspace {
public:
  Workspace() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.postorder = 0; // CAMD has done so within the constraints
    common_.final_ll = 1;  // L Lᵀ, simplicial too: its last block is the factor of the Schur complement
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace() {
    for (cholmod_dense** dense : {&solution, &work, &moreWork})
      cholmod_free_dense(dense, &common_);
    cholmod_finish(&common_);
  }
  [[nodiscard]] cholmod_common* get() { return &common_; }

  cholmod_dense *solution = nullptr, *work = nullptr,
                *moreWork = nullptr; ///< of the last solve, for the next one

private:
  cholmod_common common_{};
};

Workspace& workspace() {
  static Workspace instance;
  return instance;
}

cholmod_common* common() {
  return workspace().get();
}

struct FreeFactor {
  void operator()(cholmod_factor* factor) const { cholmod_free_factor(&factor, common()); }
};
using FactorHandle = std::unique_ptr<cholmod_factor, FreeFactor>;

/// What CHOLMOD says of the last call, for people.
std::string failureText() {
  switch (common()->status) {
  case CHOLMOD_OUT_OF_MEMORY:
    return "out of memory; spread the run over more machines, or make the mesh or the subdomains smaller";
  case CHOLMOD_TOO_LARGE:
    return "the factor is too large for 32-bit indices";
  default:
    return "CHOLMOD's status " + std::to_string(common()->status);
  }
}

/// The lower triangle of a matrix of which both are stored, as CHOLMOD sees it. Nothing is copied.
cholmod_sparse viewOf(const SparseMatrix& matrix) {
  cholmod_sparse view{};
  view.nrow = view.ncol = matrix.rows();
  view.nzmax = matrix.nonZeros();
  view.p = const_cast<int*>(matrix.outerIndexPtr()); // NOLINT: CHOLMOD's interface knows no const
  view.i = const_cast<int*>(matrix.innerIndexPtr()); // NOLINT
  view.x = const_cast<double*>(matrix.valuePtr());   // NOLINT
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense viewOf(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  cholmod_dense view{};
  view.nrow = matrix.rows();
  view.ncol = matrix.cols();
  view.d = matrix.outerStride();
  view.nzmax = view.d * view.ncol;
  view.x = const_cast<double*>(matrix.data()); // NOLINT
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

} // namespace

class CholmodPattern {
public:
  CholmodPattern(const SparseMatrix& matrix, std::vector<int> kept)
      : start_(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.rows() + 1),
        rows_(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros()), kept_(std::move(kept)) {
    std::vector<int> group(matrix.rows(), 0), order(group.size());
    if (kept_.size() < group.size()) // CAMD takes groups below n only
      for (const int unknown : kept_)
        group[unknown] = 1;
    cholmod_sparse view = viewOf(matrix);
    if (cholmod_camd(&view, nullptr, 0, group.data(), order.data(), common()) == 0)
      throw Error("a matrix of " + std::to_string(matrix.rows()) +
                  " unknowns could not be ordered: " + failureText());
    common()->method[0].ordering = CHOLMOD_GIVEN;
    symbolic_.reset(cholmod_analyze_p(&view, order.data(), nullptr, 0, common()));
    if (!symbolic_)
      throw Error("a matrix of " + std::to_string(matrix.rows()) +
                  " unknowns could not be analysed: " + failureText());
    // Position of each kept unknown, in the order given, within the last block.
    std::vector<int> position(group.size(), 0);
    for (std::size_t i = 0; i < order.size(); ++i)
      position[order[i]] = static_cast<int>(i);
    const int first = static_cast<int>(order.size() - kept_.size());
    for (const int unknown : kept_)
      place_.push_back(position[unknown] - first);
  }

  [[nodiscard]] bool fits(const SparseMatrix& matrix, const std::vector<int>& kept) const {
    return matrix.rows() + 1 == std::ssize(start_) && matrix.nonZeros() == std::ssize(rows_) &&
           kept == kept_ && std::equal(start_.begin(), start_.end(), matrix.outerIndexPtr()) &&
           std::equal(rows_.begin(), rows_.end(), matrix.innerIndexPtr());
  }
  [[nodiscard]] FactorHandle makeFactor() const {
    return FactorHandle(cholmod_copy_factor(symbolic_.get(), common()));
  }
  /// Where the kept unknowns, in the order given, stand in the factor's last block.
  [[nodiscard]] const std::vector<int>& place() const { return place_; }

private:
  std::vector<int> start_, rows_, kept_, place_;
  FactorHandle symbolic_;
};

namespace {

class CholmodFactor final : public SpdFactor {
public:
  CholmodFactor(const SparseMatrix& matrix, std::shared_ptr<const CholmodPattern> pattern)
      : pattern_(std::move(pattern)), factor_(pattern_->makeFactor()) {
    const OneThread guard;
    cholmod_sparse view = viewOf(matrix);
    if (!factor_ || cholmod_factorize(&view, factor_.get(), common()) == 0)
      throw Error(failureText());
    if (factor_->minor < factor_->n)
      throw Error("the matrix is not positive definite");
    lastBlock_.emplace(*factor_, static_cast<int>(pattern_->place().size()));
    kept_.resize(pattern_->place().size());
  }
  [[nodiscard]] int size() const override { return static_cast<int>(factor_->n); }

  void solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x) override {
    if (b.cols() == 0)
      return;
    const OneThread guard;
    cholmod_dense rhs = viewOf(b);
    Workspace& space = workspace();
    if (cholmod_solve2(CHOLMOD_A, factor_.get(), &rhs, nullptr, &space.solution, nullptr, &space.work,
                       &space.moreWork, common()) == 0)
      throw Error("a solve failed: " + failureText());
    x = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(space.solution->x), b.rows(), b.cols());
  }

  [[nodiscard]] const std::shared_ptr<const CholmodPattern>& pattern() const { return pattern_; }

  Eigen::MatrixXd schurComplement() override { return inGivenOrder(productOfFactor(lastBlock_->dense())); }
  Eigen::MatrixXd inverseOfKept() override { return inGivenOrder(inverseFromFactor(lastBlock_->dense())); }

  void multiplyKept(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> y) override {
    const OneThread guard;
    kept_(pattern_->place()) = x;
    lastBlock_->multiply(kept_.data());
    y = kept_(pattern_->place());
  }
  void solveKept(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> x) override {
    const OneThread guard;
    kept_(pattern_->place()) = b;
    lastBlock_->solve(kept_.data());
    x = kept_(pattern_->place());
  }
  [[nodiscard]] std::size_t numKeptEntries() const override { return lastBlock_->numEntries(); }

  [[nodiscard]] std::size_t bytes() const override {
    return numEntries() * sizeof(double) +
           (factor_->is_super != 0 ? factor_->ssize : factor_->nzmax) * sizeof(int);
  }
  [[nodiscard]] std::size_t numEntries() const override {
    return factor_->is_super != 0 ? factor_->xsize : factor_->nzmax;
  }

private:
  [[nodiscard]] Eigen::MatrixXd inGivenOrder(const Eigen::MatrixXd& block) const {
    return block(pattern_->place(), pattern_->place());
  }

  std::shared_ptr<const CholmodPattern> pattern_;
  FactorHandle factor_;
  std::optional<LastBlock> lastBlock_; ///< of the factor
  Eigen::VectorXd kept_;               ///< work, in its order
};

} // namespace

std::shared_ptr<const CholmodPattern> analyzePattern(const SparseMatrix& matrix,
                                                     const std::vector<int>& kept) {
  return std::make_shared<const CholmodPattern>(matrix, kept);
}

bool fits(const CholmodPattern& pattern, const SparseMatrix& matrix, const std::vector<int>& kept) {
  return pattern.fits(matrix, kept);
}

std::shared_ptr<const CholmodPattern> patternOf(const SpdFactor& factor) {
  const auto* own = dynamic_cast<const CholmodFactor*>(&factor);
  return own != nullptr ? own->pattern() : nullptr;
}

std::unique_ptr<SpdFactor> factorizeByCholmod(const SparseMatrix& matrix,
                                              std::shared_ptr<const CholmodPattern> pattern,
                                              const std::string& what) {
  try {
    return std::make_unique<CholmodFactor>(matrix, std::move(pattern));
  } catch (const Error& error) {
    throw Error("the matrix of " + what + " (" + std::to_string(matrix.rows()) +
                " unknowns) could not be factorised by CHOLMOD: " + error.what());
  }
}

} // namespace epafi::direct
