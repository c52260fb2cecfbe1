// What of DualProblem depends on loads and gaps.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/Contradiction.hpp"
#include "epafi/fetidp/DualPreconditioner.hpp"
#include "epafi/fetidp/DualProblem.hpp"
#include "epafi/fetidp/Recovery.hpp"
#include "epafi/fetidp/ShiftedObserver.hpp"
#include "epafi/fetidp/Solvability.hpp"
#include "epafi/qp/BoundProblem.hpp"
#include "epafi/qp/Box.hpp"
#include "epafi/qp/ConjugateGradient.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace epafi::fetidp {

SubdomainVectors loadsOf(const decomposition::DecomposedProblem& problem) {
  SubdomainVectors loads;
  loads.reserve(problem.subdomains.size());
  for (const auto& subdomain : problem.subdomains)
    loads.emplace_back(subdomain.load);
  return loads;
}

namespace {

/// Throws InputError on all ranks if a load or a gap is NaN or infinite. Collective.
void requireFiniteData(const decomposition::DecomposedProblem& problem) {
  collectively(*problem.comm, [&] {
    for (const auto& subdomain : problem.subdomains)
      if (!subdomain.load.allFinite())
        throw InputError("the load of body '" +
                         problem.bodies[static_cast<std::size_t>(subdomain.body)].name +
                         "' has an entry in subdomain " + std::to_string(subdomain.number) +
                         " that is not a finite number; check its loads and supports");
    const auto gaps = problem.gap->getData();
    for (Teuchos_Ordinal i = 0; i < gaps.size(); ++i)
      if (!std::isfinite(gaps[i]))
        throw InputError(
            "the gap of contact row " +
            std::to_string(problem.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i))) +
            " is not a finite number; check the gaps");
  });
}

/// A fraction of the discretisation error, of the displacements that go with an iterate.
class BalancedTarget final : public qp::ErrorTarget {
public:
  /// Keeps references. \param complete  makes λ of an iterate
  BalancedTarget(const decomposition::DecomposedProblem& problem, GeneralizedInverse& inverse,
                 const ErrorBalance& balance, std::function<void(Vector&)> complete)
      : problem_(problem), inverse_(inverse), balance_(balance), complete_(std::move(complete)) {}

  /// A first look at the discretisation error when the algebraic one has fallen so far that it hardly blurs it.
  double first(double error) override {
    constexpr double share = 0.01; // discretisation errors are per cents of the solution
    return balance_.expected > 0 ? balance_.fraction * balance_.expected : share * error;
  }
  double at(const Vector& x) override {
    Vector lambda(x, Teuchos::Copy);
    complete_(lambda);
    last_ = balance_.fraction * balance_.estimate(displacementOf(problem_, inverse_, lambda));
    return last_;
  }
  [[nodiscard]] double last() const { return last_; }

private:
  const decomposition::DecomposedProblem& problem_;
  GeneralizedInverse& inverse_;
  const ErrorBalance& balance_;
  std::function<void(Vector&)> complete_;
  double last_ = 0;
};

} // namespace

DualSolution DualProblem::solve(const Vector* start, qp::Observer* observer, const DualGoal& goal) {
  const ErrorBalance* balance = goal.balance;
  if (parameters_.isBalanced && balance == nullptr)
    throw InputError("the tolerance 'balanced' needs an estimate of the discretisation error, and none was "
                     "given; hand one "
                     "over to solve(), or ask for a number");
  if (!parameters_.isBalanced)
    balance = nullptr;
  tolerance_ = goal.tightening * parameters_.tolerance;
  requireFiniteData(problem_);
  const Eigen::VectorXd resultants = kernelLoad(problem_, loadsOf(problem_));
  requireFeasibleGaps(problem_);
  requireUniqueSolution(problem_, kernelEntries_, resultants);

  DualSolution solution;
  solution.lambda = rcp(new Vector(problem_.multiplierMap));
  if (algorithm_ == Algorithm::direct) {
    solution.report.status = qp::Status::converged;
    solution.report.reason = "solved directly";
    return solution;
  }
  const RCP<Vector> rhs = rightHandSide();
  if (!deflated_.is_null()) {
    wholeRhs_ = rcp(new Vector(*rhs, Teuchos::Copy));
    deflated_->project(*rhs);
  }
  if (algorithm_ == Algorithm::smalbe)
    solveSemicoercive(rhs, resultants, start, observer, balance, solution);
  else
    solveCoercive(rhs, start, observer, balance, solution);
  completeJumps(*solution.lambda);
  if (solution.report.status == qp::Status::unbounded && !solution.report.certificate.is_null() &&
      provesContradiction(problem_, *solution.report.certificate))
    throw SolvabilityError(
        SolvabilityError::Kind::noSolution,
        "no solution: contact rows contradict each other, no displacement satisfies them all; change a gap, "
        "an obstacle or a direction of contact");
  return solution;
}

RCP<Vector> DualProblem::startFrom(std::span<const Eigen::VectorXd> displacement) const {
  if (dirichlet_.is_null())
    return Teuchos::null;
  SubdomainVectors given;
  for (std::size_t s = 0; s < problem_.subdomains.size(); ++s)
    given.emplace_back(decomposition::unknownsOf(problem_.subdomains[s], displacement[s]));
  const RCP<Vector> lambda = dirichlet_->multipliersOf(problem_, given);
  const auto values = lambda->getDataNonConst();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
    if (problem_.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i)) < problem_.numInequalities)
      values[i] = std::max(values[i], 0.0);
  return lambda;
}

/// λ of the iterate of the deflated problem. Collective.
void DualProblem::completeJumps(Vector& lambda) const {
  if (!deflated_.is_null())
    deflated_->complete(*wholeRhs_, lambda);
}

/// d̃ = B̄ K̄⁺ f̄ − c. Keeps the size of what it is the difference of, max |K̄⁺f̄| + max |c|.
RCP<Vector> DualProblem::rightHandSide() {
  SubdomainVectors u;
  inverse_->apply(loadsOf(problem_), u);
  MultiplierExchange exchange(inverse_->multiplierPlan());
  inverse_->constraint(u, exchange.values());
  const RCP<Vector> rhs = rcp(new Vector(problem_.multiplierMap));
  exchange.sumToOwners(*rhs);
  rhs->update(-1.0, *problem_.gap, 1.0);
  double largest = 0;
  for (const Eigen::MatrixXd& values : u)
    largest = values.size() > 0 ? std::max(largest, values.lpNorm<Eigen::Infinity>()) : largest;
  termSize_ = maxOverRanks(*problem_.comm, largest) + problem_.gap->normInf();
  return rhs;
}

/// 0 for multipliers of contact, `free` for those of gluing.
RCP<Vector> DualProblem::lowerBounds(double free) const {
  const RCP<Vector> lower = rcp(new Vector(problem_.multiplierMap));
  const auto values = lower->getDataNonConst();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
    if (problem_.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i)) >= problem_.numInequalities)
      values[i] = free;
  return lower;
}

/// Residuals are relative to ‖d̃‖ or ‖Pd‖. One that is the round-off of its terms is set to zero, and their size
/// becomes the measure; returns whether that is so. Collective.
bool DualProblem::setReference(Vector& rhs, DualSolution& solution) const {
  const bool vanishes = rhs.normInf() <= 1e-13 * termSize_;
  if (vanishes)
    rhs.putScalar(0.0);
  solution.reference = vanishes ? termSize_ : accurateNorm(rhs);
  return vanishes;
}

void DualProblem::solveCoercive(const RCP<Vector>& rhs, const Vector* start, qp::Observer* observer,
                                const ErrorBalance* balance, DualSolution& solution) {
  const bool vanishes = setReference(*rhs, solution);
  if (start != nullptr && !vanishes) // else λ = 0 solves it, and no other start gets there
    solution.lambda->assign(*start);
  if (algorithm_ == Algorithm::conjugateGradient && balance == nullptr) {
    solution.report = qp::solveUnconstrained(hessian_, rhs, solution.lambda, tolerance_,
                                             parameters_.mprgp.maxMultiplications, observer, preconditioner_);
    return;
  }
  const RCP<const qp::ConvexSet> set =
      rcp(new qp::Box(lowerBounds(-std::numeric_limits<double>::infinity())));
  const qp::BoundProblem problem{hessian_, rhs, set, preconditioner_, norm_.norm};
  const double reference = accurateNorm(*rhs);
  if (balance != nullptr && reference > 0) { // without contact this is CG, step by step
    BalancedTarget target(problem_, *inverse_, *balance, [this](Vector& x) { completeJumps(x); });
    qp::ErrorRule rule(target, reference);
    solution.report =
        qp::solveBoundProblem(problem, *solution.lambda, rule, reference, parameters_.mprgp, observer);
    solution.errorTarget = target.last();
    return;
  }
  solution.report = qp::solveBoundProblem(problem, *solution.lambda, {tolerance_, reference, 0.0},
                                          parameters_.mprgp, observer);
}

/// With λ = λ̃ + μ: min ½μᵀPFPμ − μᵀPd, Gμ = 0, μ_I ≥ −λ̃_I, where d = d̃ − Fλ̃.
void DualProblem::solveSemicoercive(const RCP<Vector>& rhs, const Eigen::VectorXd& resultants,
                                    const Vector* start, qp::Observer* observer, const ErrorBalance* balance,
                                    DualSolution& solution) {
  const Eigen::VectorXd e = coarseSpace_->normalized(resultants);
  Vector feasible(problem_.multiplierMap); // λ̃ = Gᵀe
  coarseSpace_->feasiblePoint(e, feasible);
  flexibility()->apply(feasible, *rhs, Teuchos::NO_TRANS, -1.0, 1.0); // d = d̃ − Fλ̃
  coarseSpace_->project(*rhs);                                        // Pd
  const bool vanishes = setReference(*rhs, solution);
  // e vanishes where a balanced load is held by contacts on both sides: then forces are measured by what Pd
  // asks for.
  const double largest = coarseSpace_->normalized(kernelLoadMagnitude(problem_, loadsOf(problem_))).norm();
  const bool isBalanced = e.norm() <= resultantTolerance * largest;
  const double equilibriumReference = !isBalanced      ? e.norm()
                                      : norm_.norm > 0 ? solution.reference / norm_.norm
                                                       : 0.0;

  const RCP<Vector> lower = lowerBounds(-std::numeric_limits<double>::infinity());
  lower->update(-1.0, feasible, 1.0); // −λ̃_I
  Vector mu(problem_.multiplierMap);
  if (start != nullptr && !vanishes)
    mu.update(1.0, *start, -1.0, feasible, 0.0);

  qp::SmalbeTolerances tolerances{tolerance_, solution.reference, parameters_.equilibriumTolerance,
                                  equilibriumReference};
  std::optional<BalancedTarget> target;
  if (balance != nullptr && !vanishes) {
    tolerances.error = &target.emplace(problem_, *inverse_, *balance, [&](Vector& x) {
      x.update(1.0, feasible, 1.0);
      completeJumps(x);
    });
  }
  const RCP<const qp::ConvexSet> set = rcp(new qp::Box(lower));
  std::vector<double> multiplier;
  std::optional<ShiftedObserver> shifted;
  if (observer != nullptr)
    observer = &shifted.emplace(*observer, feasible);
  solution.report =
      qp::solveEqualityBoundProblem({hessian_, rhs, set, coarseSpace_, preconditioner_, norm_.norm}, mu,
                                    multiplier, tolerances, parameters_.smalbe, parameters_.mprgp, observer);
  if (target)
    solution.errorTarget = target->last();
  solution.lambda->update(1.0, mu, 1.0, feasible, 0.0);
  const Eigen::VectorXd imbalance = coarseSpace_->product(*solution.lambda) - e;
  solution.equilibrium =
      equilibriumReference > 0 ? imbalance.norm() / equilibriumReference : imbalance.norm();
}

} // namespace epafi::fetidp
