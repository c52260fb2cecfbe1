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

fetidp::DualParameters dualParameters(const FetiDpParameters& parameters) {
  fetidp::DualParameters dual;
  dual.dualOperator = parameters.dualOperator;
  dual.preconditioner = parameters.preconditioner;
  dual.adaptiveConstraints = parameters.adaptiveConstraints;
  return dual;
}

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

/// r = b − Kx.
void residualOf(const UnassembledOperator& k, const MultiVector& b, const MultiVector& x, MultiVector& r) {
  r.assign(b);
  k.apply(x, r, Teuchos::NO_TRANS, -1.0, 1.0);
}

/// Columns whose residuals are larger than their goals.
std::vector<std::size_t> unmet(const std::vector<double>& residuals, const std::vector<double>& goals) {
  std::vector<std::size_t> columns;
  for (std::size_t j = 0; j < residuals.size(); ++j)
    if (!(residuals[j] <= goals[j]))
      columns.push_back(j);
  return columns;
}

std::vector<double> pick(const std::vector<double>& values, const std::vector<std::size_t>& columns) {
  std::vector<double> picked;
  for (const std::size_t column : columns)
    picked.push_back(values[column]);
  return picked;
}

std::string reasonOf(const LinearReport& report, DualOutcome::Status status) {
  if (report.converged)
    return "the residual of the solution is as small as was asked for";
  if (status == DualOutcome::Status::limit)
    return "stopped after " + std::to_string(report.iterations) +
           " iterations; allow more by \"Maximum Iterations\", or raise the tolerance";
  if (status == DualOutcome::Status::indefinite)
    return "a direction with negative energy was met: K of a subdomain is not positive definite once it is "
           "held at the crosspoints";
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
                                                            parameters.directSolvers)),
      dual_(k_->problem(), inverse_, dualParameters(parameters)),
      shares_(k_->problem(), k_->exchange(), parameters.preconditioner.scaling),
      primal_(*k_, *inverse_, parameters.preconditioner.scaling), multipliers_(inverse_->multiplierPlan()) {}

LinearReport FetiDpSolver::solve(const MultiVector& b, MultiVector& x, double tolerance,
                                 ResidualReference reference) {
  const std::vector<double> sizes = norms(b);
  requireFinite(sizes, "the right-hand side");
  requireFinite(norms(x), "the start vector");
  MultiVector residual(b.getMap(), b.getNumVectors());
  for (std::size_t j = 0; j < sizes.size(); ++j)
    if (sizes[j] == 0)
      x.getVectorNonConst(j)->putScalar(0.0); // the solution, to the last digit
  residualOf(*k_, b, x, residual);
  std::vector<double> residuals = norms(residual);
  const std::vector<double> references = reference == ResidualReference::rightHandSide ? sizes : residuals;
  std::vector<double> goals = references;
  for (double& goal : goals)
    goal *= tolerance;

  LinearReport report;
  DualOutcome outcome;
  constexpr int maxCorrections = 4; // of what round-off in one leaves over
  for (int correction = 0; correction < maxCorrections && outcome.status == DualOutcome::Status::reached;
       ++correction) {
    const std::vector<std::size_t> open = unmet(residuals, goals);
    if (open.empty())
      break;
    const Teuchos::ArrayView<const std::size_t> columns = Teuchos::arrayViewFromVector(open);
    const RCP<MultiVector> better = x.subCopy(columns);
    outcome = correct(*residual.subView(columns), pick(goals, open),
                      parameters_.maxIterations - report.iterations, *better);
    report.iterations += outcome.steps;
    const RCP<MultiVector> left = rcp(new MultiVector(b.getMap(), open.size()));
    residualOf(*k_, *b.subView(columns), *better, *left);
    const std::vector<double> now = norms(*left);
    bool isBetter = false;
    for (std::size_t j = 0; j < open.size(); ++j)
      if (now[j] < residuals[open[j]]) {
        isBetter = isBetter || now[j] < 0.5 * residuals[open[j]];
        x.getVectorNonConst(open[j])->assign(*better->getVector(j));
        residual.getVectorNonConst(open[j])->assign(*left->getVector(j));
        residuals[open[j]] = now[j];
      }
    if (!isBetter)
      break;
  }
  for (std::size_t j = 0; j < residuals.size(); ++j)
    report.relativeResiduals.push_back(references[j] > 0 ? residuals[j] / references[j] : residuals[j]);
  report.converged = unmet(residuals, goals).empty();
  report.reason = reasonOf(report, outcome.status);
  return report;
}

/// x += K⁻¹ r, but for what the goals allow to be left.
DualOutcome FetiDpSolver::correct(const MultiVector& residual, std::span<const double> goals, int maxSteps,
                                  MultiVector& x) {
  const auto& subdomains = k_->problem().subdomains;
  k_->exchange().toSubdomains(residual, forces_);
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    toForcesOfUnknowns(subdomains[s], forces_[s]);
  shares_.scale(forces_); // f̄
  const DualOutcome outcome = solveDual(goals, maxSteps);
  shares_.scale(torn_);
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    toValues(subdomains[s], torn_[s]);
  MultiVector mean(x.getMap(), x.getNumVectors());
  k_->exchange().sum(torn_, mean);
  x.update(1.0, mean, 1.0);
  return outcome;
}

/// λ of the forces, and the torn solution K̄⁻¹(f̄ − B̄ᵀλ), which jumps as far as the goals allow.
DualOutcome FetiDpSolver::solveDual(std::span<const double> goals, int maxSteps) {
  const std::size_t numColumns = goals.size();
  const int columns = static_cast<int>(numColumns);
  inverse_->apply(forces_, torn_, columns);
  if (dual_.algorithm() == fetidp::Algorithm::direct)
    return {};
  inverse_->constraint(torn_, multipliers_.values(numColumns));
  const RCP<MultiVector> rhs = rcp(new MultiVector(k_->problem().multiplierMap, numColumns)); // d̃ = B̄K̄⁻¹f̄
  multipliers_.sumToOwners(*rhs);
  const auto deflated = dual_.deflatedOperator();
  const RCP<MultiVector> whole = rcp(new MultiVector(*rhs, Teuchos::Copy));
  for (std::size_t j = 0; j < numColumns && !deflated.is_null(); ++j)
    deflated->project(*rhs->getVectorNonConst(j));
  const RCP<MultiVector> lambda = rcp(new MultiVector(rhs->getMap(), numColumns));
  const DualOutcome outcome =
      iterateDual(dual_.hessian(), dual_.preconditioner(), rhs, lambda, primal_, goals, maxSteps);
  for (std::size_t j = 0; j < numColumns && !deflated.is_null(); ++j)
    deflated->complete(*whole->getVector(j), *lambda->getVectorNonConst(j));
  inverse_->subtractForces(multipliers_.toSubdomains(*lambda), forces_);
  inverse_->apply(forces_, torn_, columns);
  return outcome;
}

} // namespace epafi::linear
