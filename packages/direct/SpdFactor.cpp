#include "epafi/direct/SpdFactor.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/direct/AmesosFactor.hpp"
#include "epafi/direct/CholmodFactor.hpp"

#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>
#include <utility>

namespace epafi::direct {
namespace {

constexpr const char* cholmod = "CHOLMOD";

/// The factor of a matrix without rows.
class EmptyFactor final : public SpdFactor {
public:
  [[nodiscard]] int size() const override { return 0; }
  void solve(const Eigen::Ref<const Eigen::MatrixXd>&, Eigen::Ref<Eigen::MatrixXd>) override {}
  Eigen::MatrixXd schurComplement() override { return {}; }
  Eigen::MatrixXd inverseOfKept() override { return {}; }
  void multiplyKept(const Eigen::Ref<const Eigen::VectorXd>&, Eigen::Ref<Eigen::VectorXd>) override {}
  void solveKept(const Eigen::Ref<const Eigen::VectorXd>&, Eigen::Ref<Eigen::VectorXd>) override {}
  [[nodiscard]] std::size_t bytes() const override { return 0; }
  [[nodiscard]] std::size_t numEntries() const override { return 0; }
  [[nodiscard]] std::size_t numKeptEntries() const override { return 0; }
};

void requireKnown(const std::string& solver) {
  const std::vector<std::string> names = availableSolvers();
  if (std::find(names.begin(), names.end(), solver) != names.end())
    return;
  std::string known;
  for (const std::string& name : names)
    known += (known.empty() ? "" : ", ") + name;
  throw InputError("the direct solver '" + solver + "' is not known to this build; use one of: " + known);
}

/// Makes the BLAS take its work space now. OpenBLAS does so at its first product, 128 MiB of addresses, keeps
/// it, and if there is no such memory, asks for it for ever: a rank short of memory would hang there. So it
/// is asked for here first.
/// \throws std::bad_alloc if it is not to be had. Not collective.
void takeBlasMemory() {
  static const bool isTaken = [] {
    constexpr std::size_t needed = std::size_t{132} << 20U; // 128 MiB and what surrounds them
    void* volatile probe = std::malloc(needed);             // volatile: a compiler may leave the pair out
    if (probe == nullptr)
      throw std::bad_alloc();
    std::free(probe);
    std::array<double, 4> matrix{2, 1, 1, 2};
    int info = 0;
    Teuchos::LAPACK<int, double>().POTRF('L', 2, matrix.data(), 2, &info);
    return info == 0;
  }();
  static_cast<void>(isTaken);
}

} // namespace

Factorizer::Factorizer(std::string solver) : solver_(std::move(solver)) {
  requireKnown(solver_);
  takeBlasMemory();
}

std::unique_ptr<SpdFactor> Factorizer::factorize(const SparseMatrix& matrix, const std::vector<int>& kept,
                                                 const std::string& what, const SpdFactor* like) {
  if (matrix.rows() == 0)
    return std::make_unique<EmptyFactor>();
  if (solver_ != cholmod) {
    ++numSymbolic_;
    try {
      return factorizeByAmesos(matrix, kept, solver_);
    } catch (const std::exception& error) {
      throw Error("the matrix of " + what + " (" + std::to_string(matrix.rows()) +
                  " unknowns) could not be factorised by " + solver_ + ": " + error.what());
    }
  }
  constexpr std::size_t numRemembered = 32;
  auto& known = patterns_;
  const auto earlier = like != nullptr ? patternOf(*like) : nullptr;
  if (earlier && std::find(known.begin(), known.end(), earlier) == known.end())
    known.insert(known.begin(), earlier);
  auto found = std::find_if(known.begin(), known.end(),
                            [&](const auto& pattern) { return fits(*pattern, matrix, kept); });
  if (found == known.end()) {
    known.insert(known.begin(), analyzePattern(matrix, kept));
    ++numSymbolic_;
  } else {
    std::rotate(known.begin(), found, found + 1);
  }
  known.resize(std::min(known.size(), numRemembered));
  return factorizeByCholmod(matrix, known.front(), what);
}

std::vector<std::string> availableSolvers() {
  std::vector<std::string> names = amesosSolvers();
  names.emplace_back(cholmod);
  return names;
}

std::string fastestSolver() {
  return cholmod;
}

std::unique_ptr<SpdFactor> factorize(const SparseMatrix& matrix, const std::string& solver,
                                     const std::string& what) {
  return Factorizer(solver).factorize(matrix, {}, what);
}

} // namespace epafi::direct
