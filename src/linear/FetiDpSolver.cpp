#include "epafi/linear/FetiDpSolver.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/linear/LinearProblemChecks.hpp"
#include "epafi/linear/NodalBasis.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::linear {
namespace {

std::vector<double> norms(const MultiVector& x) {
  std::vector<double> result(x.getNumVectors());
  x.norm2(Teuchos::arrayViewFromVector(result));
  return result;
}

void requireFinite(const std::vector<double>& columns, const char* what) {
  for (std::size_t j = 0; j < columns.size(); ++j)
    if (!std::isfinite(columns[j]))
      throw InputError(std::string(what) + " has an entry in column " + std::to_string(j) +
                       " that is not a finite number, or too large to be squared; check it");
}

} // namespace

/// Where the columns of a solve stand.
struct FetiDpSolver::Columns {
  const MultiVector& b;
  MultiVector& x;
  MultiVector residual;                         ///< b − Kx
  std::vector<double> norms, references, goals; ///< ‖b − Kx‖, what it is relative to, and what it may be

  /// Those whose residuals are larger than they may be.
  [[nodiscard]] std::vector<std::size_t> open() const {
    std::vector<std::size_t> columns;
    for (std::size_t j = 0; j < norms.size(); ++j)
      if (!(norms[j] <= goals[j]))
        columns.push_back(j);
    return columns;
  }
};

namespace {

/// r = b − Kx.
void residualOf(const UnassembledOperator& k, const MultiVector& b, const MultiVector& x, MultiVector& r) {
  r.assign(b);
  k.apply(x, r, Teuchos::NO_TRANS, -1.0, 1.0);
}

std::string reasonOf(const LinearReport& report, DualOutcome::Status status) {
  if (report.converged)
    return "the residual of the solution is as small as was asked for";
  if (status == DualOutcome::Status::limit)
    return "stopped after " + std::to_string(report.iterations) +
           " iterations; allow more by \"Maximum Iterations\", or raise the tolerance";
  if (status == DualOutcome::Status::indefinite)
    return "a direction without energy was met: K of a subdomain that is held at the crosspoints is not "
           "positive definite, or round-off is all that is left";
  return "round-off allows no smaller residual; raise the tolerance";
}

} // namespace

double LinearReport::largestResidual() const {
  return relativeResiduals.empty() ? 0.0
                                   : *std::max_element(relativeResiduals.begin(), relativeResiduals.end());
}

FetiDpSolver::FetiDpSolver(RCP<const UnassembledOperator> k, const FetiDpParameters& parameters)
    : k_(std::move(k)), parameters_(parameters),
      inverse_(std::make_shared<fetidp::GeneralizedInverse>(requireLinearProblem(*k_, "FETI-DP"),
                                                            parameters.directSolvers)) {
  prepare();
}

void FetiDpSolver::update() {
  dual_.reset(); // should this fail, there is none; and nothing else holds the inverse
  const auto& problem = requireLinearProblem(*k_, "FETI-DP");
  inverse_ =
      std::make_shared<fetidp::GeneralizedInverse>(problem, parameters_.directSolvers, std::move(inverse_));
  prepare();
}

/// What is made of the inverse.
void FetiDpSolver::prepare() {
  const auto scaling = parameters_.preconditioner.scaling;
  dual_ = std::make_unique<fetidp::DualProblem>(
      k_->problem(), decomposition::ProblemData(), inverse_,
      fetidp::DualParameters{static_cast<const fetidp::FetiParameters&>(parameters_)});
  shares_ = std::make_unique<CopyShares>(k_->problem(), k_->exchange(), scaling);
  primal_ = std::make_unique<PrimalResidual>(*k_, *inverse_, scaling);
  multipliers_ = std::make_unique<fetidp::MultiplierExchange>(inverse_->multiplierPlan());
}

FetiDpSolver::Columns FetiDpSolver::begin(const MultiVector& b, MultiVector& x, double tolerance,
                                          ResidualReference reference) const {
  const std::vector<double> sizes = norms(b);
  requireFinite(sizes, "the right-hand side");
  requireFinite(norms(x), "the start vector");
  for (std::size_t j = 0; j < sizes.size(); ++j)
    if (sizes[j] == 0)
      x.getVectorNonConst(j)->putScalar(0.0); // the solution, to the last digit
  Columns columns{b, x, MultiVector(b.getMap(), b.getNumVectors()), {}, {}, {}};
  residualOf(*k_, b, x, columns.residual);
  columns.norms = norms(columns.residual);
  columns.references = reference == ResidualReference::rightHandSide ? sizes : columns.norms;
  for (const double size : columns.references)
    columns.goals.push_back(tolerance * size);
  return columns;
}

LinearReport FetiDpSolver::solve(const MultiVector& b, MultiVector& x, double tolerance,
                                 ResidualReference reference) {
  if (!dual_)
    throw Error("FetiDpSolver::solve was called after an update that failed; call update again first");
  Columns columns = begin(b, x, tolerance, reference);
  LinearReport report;
  DualOutcome outcome;
  constexpr int maxCorrections = 4; // of what round-off in one leaves over
  bool isBetter = true;
  for (int correction = 0; correction < maxCorrections && isBetter && !columns.open().empty() &&
                           outcome.status == DualOutcome::Status::reached;
       ++correction) {
    isBetter = improve(columns, parameters_.maxIterations - report.iterations, outcome);
    report.iterations += outcome.steps;
  }
  for (std::size_t j = 0; j < columns.norms.size(); ++j)
    report.relativeResiduals.push_back(columns.references[j] > 0 ? columns.norms[j] / columns.references[j]
                                                                 : columns.norms[j]);
  report.converged = columns.open().empty();
  report.reason = reasonOf(report, outcome.status);
  return report;
}

/// Corrects the columns that are open, as far as that is of use; returns whether the residual of one has
/// fallen by half.
bool FetiDpSolver::improve(Columns& columns, int maxSteps, DualOutcome& outcome) {
  const std::vector<std::size_t> open = columns.open();
  const auto indices = Teuchos::arrayViewFromVector(open);
  std::vector<double> goals;
  for (const std::size_t j : open)
    goals.push_back(columns.goals[j]);
  const RCP<MultiVector> x = columns.x.subCopy(indices);
  outcome = correct(*columns.residual.subView(indices), goals, maxSteps, *x);
  MultiVector residual(x->getMap(), open.size());
  residualOf(*k_, *columns.b.subView(indices), *x, residual);
  const std::vector<double> now = norms(residual);
  bool hasHalved = false;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const std::size_t j = open[i];
    if (!(now[i] < columns.norms[j]))
      continue;
    hasHalved = hasHalved || now[i] < 0.5 * columns.norms[j];
    columns.x.getVectorNonConst(j)->assign(*x->getVector(i));
    columns.residual.getVectorNonConst(j)->assign(*residual.getVector(i));
    columns.norms[j] = now[i];
  }
  return hasHalved;
}

/// x += K⁻¹ r, but for what the goals allow to be left.
DualOutcome FetiDpSolver::correct(const MultiVector& residual, std::span<const double> goals, int maxSteps,
                                  MultiVector& x) {
  const auto& subdomains = k_->problem().subdomains;
  k_->exchange().toSubdomains(residual, forces_);
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    toForcesOfUnknowns(subdomains[s], forces_[s]);
  shares_->scale(forces_); // f̄
  const DualOutcome outcome = solveDual(goals, maxSteps);
  shares_->scale(torn_);
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    toValues(subdomains[s], torn_[s]);
  MultiVector mean(x.getMap(), x.getNumVectors());
  k_->exchange().sum(torn_, mean);
  k_->copyIdentity(residual, mean);
  x.update(1.0, mean, 1.0);
  return outcome;
}

/// λ of the forces, and the torn solution K̄⁻¹(f̄ − B̄ᵀλ), which jumps as far as the goals allow.
DualOutcome FetiDpSolver::solveDual(std::span<const double> goals, int maxSteps) {
  const std::size_t numColumns = goals.size();
  const int columns = static_cast<int>(numColumns);
  inverse_->apply(forces_, torn_, columns, work_);
  if (dual_->algorithm() == fetidp::Algorithm::direct)
    return {};
  inverse_->constraint(torn_, multipliers_->values(numColumns));
  const RCP<MultiVector> rhs = rcp(new MultiVector(k_->problem().multiplierMap, numColumns)); // d̃ = B̄K̄⁻¹f̄
  multipliers_->sumToOwners(*rhs);
  const auto deflated = dual_->deflatedOperator();
  const RCP<MultiVector> whole = rcp(new MultiVector(*rhs, Teuchos::Copy));
  if (!deflated.is_null())
    deflated->space().projectTransposed(*rhs);
  const RCP<MultiVector> lambda = rcp(new MultiVector(rhs->getMap(), numColumns));
  const DualOutcome outcome =
      iterateDual(dual_->hessian(), dual_->preconditioner(), rhs, lambda, *primal_, goals, maxSteps);
  if (!deflated.is_null())
    deflated->complete(*whole, *lambda);
  inverse_->subtractForces(multipliers_->toSubdomains(*lambda), forces_);
  inverse_->apply(forces_, torn_, columns, work_);
  return outcome;
}

} // namespace epafi::linear
