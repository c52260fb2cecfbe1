#include "epafi/direct/SpdFactor.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/direct/AmesosFactor.hpp"
#include "epafi/direct/BlasMemory.hpp"
#include "epafi/direct/CholmodFactor.hpp"

#include <algorithm>
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
  [[nodiscard]] std::size_t bytes() const override { return 0; }
  [[nodiscard]] std::size_t numEntries() const override { return 0; }
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

} // namespace

/// The last patterns met, the latest first: subdomains of one kind follow each other.
struct Factorizer::Patterns {
  std::vector<std::shared_ptr<const CholmodPattern>> known;
};

Factorizer::Factorizer(std::string solver)
    : solver_(std::move(solver)), patterns_(std::make_unique<Patterns>()) {
  requireKnown(solver_);
  takeBlasMemory();
}
Factorizer::Factorizer(Factorizer&&) noexcept = default;
Factorizer& Factorizer::operator=(Factorizer&&) noexcept = default;
Factorizer::~Factorizer() = default;

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
  auto& known = patterns_->known;
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
