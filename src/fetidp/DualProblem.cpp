#include "epafi/fetidp/DualProblem.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/DualPreconditioner.hpp"
#include "epafi/fetidp/ProjectedOperator.hpp"
#include "epafi/fetidp/ProjectedPreconditioner.hpp"
#include "epafi/fetidp/Solvability.hpp"
#include "epafi/qp/BoundProblem.hpp"
#include "epafi/qp/Box.hpp"
#include "epafi/qp/ConjugateGradient.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace epafi::fetidp {

std::string toString(Algorithm algorithm) {
  switch (algorithm) {
  case Algorithm::direct:
    return "Direct";
  case Algorithm::conjugateGradient:
    return "CG";
  case Algorithm::mprgp:
    return "MPRGP";
  case Algorithm::smalbe:
    return "SMALBE-M";
  }
  return "Unknown";
}

SubdomainVectors loadsOf(const decomposition::DecomposedProblem& problem) {
  SubdomainVectors loads;
  loads.reserve(problem.subdomains.size());
  for (const auto& subdomain : problem.subdomains)
    loads.push_back(subdomain.load);
  return loads;
}

DualProblem::DualProblem(const decomposition::DecomposedProblem& problem,
                         std::shared_ptr<GeneralizedInverse> inverse, const DualParameters& parameters)
    : problem_(problem), inverse_(std::move(inverse)), parameters_(parameters) {
  choose();
  kernelEntries_ = kernelConstraint(problem_);
  if (algorithm_ == Algorithm::direct)
    return;
  inverse_->prepareDual(parameters_.dualOperator);
  dualOperator_ = rcp(new DualOperator(problem_, inverse_));
  hessian_ = dualOperator_;
  if (algorithm_ == Algorithm::smalbe) {
    requireContactForEveryMotion(problem_, kernelEntries_);
    const RCP<const NaturalCoarseSpace> space = rcp(new NaturalCoarseSpace(problem_, kernelEntries_));
    coarseSpace_ = space;
    hessian_ = rcp(new ProjectedOperator(dualOperator_, space));
  }
  if (algorithm_ != Algorithm::conjugateGradient)
    norm_ = qp::estimateNorm(*hessian_, parameters_.norm);
  precondition();
}

namespace {

/// Whether averages along edges are coarse unknowns, somewhere. Collective.
bool hasAverages(const decomposition::DecomposedProblem& problem) {
  const bool isHere = std::any_of(problem.subdomains.begin(), problem.subdomains.end(),
                                  [](const auto& subdomain) { return !subdomain.averages.empty(); });
  return maxOverRanks(*problem.comm, isHere ? 1.0 : 0.0) > 0;
}

} // namespace

/// Makes M, or PMP + ρ⁻¹Q for the penalty ρ that SMALBE starts with.
void DualProblem::precondition() {
  if (parameters_.preconditioner.type == PreconditionerParameters::Type::none)
    return;
  if (parameters_.mprgp.sufficientShare == 0)
    parameters_.mprgp.sufficientShare = 0.25; // most expansions would fix one multiplier or two
  if (parameters_.mprgp.proportioningConstant == 0 && hasAverages(problem_))
    parameters_.mprgp.proportioningConstant = 0.1; // few steps solve a face: those in a wrong one are lost
  const RCP<const DualPreconditioner> m =
      rcp(new DualPreconditioner(problem_, inverse_, parameters_.preconditioner));
  preconditionerBytes_ = m->bytes();
  preconditioner_ = m;
  if (algorithm_ == Algorithm::smalbe) {
    const double penalty = parameters_.smalbe.penalty * (norm_.norm > 0 ? norm_.norm : 1.0);
    preconditioner_ = rcp(new ProjectedPreconditioner(m, coarseSpace_, penalty));
  }
}

void DualProblem::choose() {
  if (problem_.dualDimension() == 0) {
    algorithm_ = Algorithm::direct;
    reason_ = "one piece without contact: one factorisation solves it, nothing to iterate";
  } else if (problem_.numInequalities == 0) {
    algorithm_ = Algorithm::conjugateGradient;
    reason_ = "no contact: the multipliers only glue subdomains, a linear problem";
  } else if (problem_.kernelDimension == 0) {
    algorithm_ = Algorithm::mprgp;
    reason_ = "contact, and every body is held by supports: bound constraints only";
  } else {
    algorithm_ = Algorithm::smalbe;
    std::string names;
    for (const auto& body : problem_.bodies)
      if (body.kernelDimension > 0)
        names += (names.empty() ? "" : ", ") + body.name;
    reason_ = "contact with floating bodies (" + names + "): bounds and equilibrium constraints";
  }
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

} // namespace

DualSolution DualProblem::solve(const Vector* start, qp::Observer* observer) {
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
  if (algorithm_ == Algorithm::smalbe)
    solveSemicoercive(rhs, resultants, start, observer, solution);
  else
    solveCoercive(rhs, start, observer, solution);
  return solution;
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
                                DualSolution& solution) {
  const bool vanishes = setReference(*rhs, solution);
  if (start != nullptr && !vanishes) // else λ = 0 solves it, and no other start gets there
    solution.lambda->assign(*start);
  if (algorithm_ == Algorithm::conjugateGradient) {
    solution.report = qp::solveUnconstrained(hessian_, rhs, solution.lambda, parameters_.tolerance,
                                             parameters_.mprgp.maxMultiplications, observer, preconditioner_);
    return;
  }
  const RCP<const qp::ConvexSet> set =
      rcp(new qp::Box(lowerBounds(-std::numeric_limits<double>::infinity())));
  solution.report =
      qp::solveBoundProblem({hessian_, rhs, set, preconditioner_, norm_.norm}, *solution.lambda,
                            {parameters_.tolerance, accurateNorm(*rhs), 0.0}, parameters_.mprgp, observer);
}

/// With λ = λ̃ + μ: min ½μᵀPFPμ − μᵀPd, Gμ = 0, μ_I ≥ −λ̃_I, where d = d̃ − Fλ̃.
void DualProblem::solveSemicoercive(const RCP<Vector>& rhs, const Eigen::VectorXd& resultants,
                                    const Vector* start, qp::Observer* observer, DualSolution& solution) {
  const Eigen::VectorXd e = coarseSpace_->normalized(resultants);
  Vector feasible(problem_.multiplierMap); // λ̃ = Gᵀe
  coarseSpace_->feasiblePoint(e, feasible);
  dualOperator_->apply(feasible, *rhs, Teuchos::NO_TRANS, -1.0, 1.0); // d = d̃ − Fλ̃
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

  const qp::SmalbeTolerances tolerances{parameters_.tolerance, solution.reference,
                                        parameters_.equilibriumTolerance, equilibriumReference};
  const RCP<const qp::ConvexSet> set = rcp(new qp::Box(lower));
  std::vector<double> multiplier;
  solution.report =
      qp::solveEqualityBoundProblem({hessian_, rhs, set, coarseSpace_, preconditioner_, norm_.norm}, mu,
                                    multiplier, tolerances, parameters_.smalbe, parameters_.mprgp, observer);
  solution.lambda->update(1.0, mu, 1.0, feasible, 0.0);
  const Eigen::VectorXd imbalance = coarseSpace_->product(*solution.lambda) - e;
  solution.equilibrium =
      equilibriumReference > 0 ? imbalance.norm() / equilibriumReference : imbalance.norm();
}

} // namespace epafi::fetidp
