#include "epafi/fetidp/DualProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/DualPreconditioner.hpp"
#include "epafi/fetidp/ProjectedOperator.hpp"
#include "epafi/fetidp/ProjectedPreconditioner.hpp"
#include "epafi/fetidp/SharedRows.hpp"
#include "epafi/fetidp/Solvability.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
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

DualProblem::DualProblem(const decomposition::DecomposedProblem& problem,
                         std::shared_ptr<GeneralizedInverse> inverse, const DualParameters& parameters)
    : problem_(problem), inverse_(std::move(inverse)), parameters_(parameters) {
  choose();
  kernelEntries_ = kernelConstraint(problem_);
  if (algorithm_ == Algorithm::direct)
    return;
  collectively(*problem_.comm, [&] { inverse_->prepareDual(parameters_.dualOperator); });
  dualOperator_ = rcp(new DualOperator(problem_, inverse_));
  deflate();
  hessian_ = flexibility();
  if (algorithm_ == Algorithm::smalbe) {
    requireContactForEveryMotion(problem_, kernelEntries_);
    const RCP<const NaturalCoarseSpace> space = rcp(new NaturalCoarseSpace(problem_, kernelEntries_));
    coarseSpace_ = space;
    hessian_ = rcp(new ProjectedOperator(flexibility(), space));
  }
  if (algorithm_ != Algorithm::conjugateGradient || parameters_.isBalanced)
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

/// Makes F_U if there are adaptive constraints.
void DualProblem::deflate() {
  using Use = AdaptiveConstraintParameters::Use;
  const AdaptiveConstraintParameters& parameters = parameters_.adaptiveConstraints;
  const bool hasPreconditioner = parameters_.preconditioner.type != PreconditionerParameters::Type::none;
  if (parameters.use == Use::no || (parameters.use == Use::automatic && !hasPreconditioner))
    return;
  const OverratedColumns columns = findOverratedColumns(problem_, *inverse_, JointKind::gluing, parameters,
                                                        parameters_.preconditioner.scaling);
  if (columns.number > 0)
    deflated_ = rcp(new DeflatedDualOperator(dualOperator_, columns));
}

RCP<const Operator> DualProblem::flexibility() const {
  if (deflated_.is_null())
    return dualOperator_;
  return deflated_;
}

/// Makes M, or PMP + ρ⁻¹Q for the penalty ρ that SMALBE starts with.
void DualProblem::precondition() {
  if (parameters_.preconditioner.type == PreconditionerParameters::Type::none)
    return;
  if (parameters_.mprgp.sufficientShare == 0)
    parameters_.mprgp.sufficientShare = 0.25; // most expansions would fix one multiplier or two
  const RCP<const DualPreconditioner> m =
      rcp(new DualPreconditioner(problem_, inverse_, parameters_.preconditioner, deflated_));
  preconditionerBytes_ = m->bytes();
  preconditioner_ = m;
  if (parameters_.preconditioner.type == PreconditionerParameters::Type::dirichlet)
    dirichlet_ = m;
  const double norm = norm_.norm > 0 ? norm_.norm : 1.0;
  std::vector<LocalOrdinal> shared = sharedContactRows(problem_);
  if (sumOverRanks(*problem_.comm, static_cast<GlobalOrdinal>(shared.size())) > 0)
    preconditioner_ = rcp(new ShiftedPreconditioner(preconditioner_, std::move(shared), 1 / norm));
  correct();
  const bool floats = algorithm_ == Algorithm::smalbe;
  if (parameters_.mprgp.proportioningConstant == 0 &&
      (floats || (hasAverages(problem_) && corrected_.is_null())))
    parameters_.mprgp.proportioningConstant = 0.1; // few steps solve a face: those in a wrong one are lost
  if (floats) {
    const double penalty = parameters_.smalbe.penalty * norm;
    preconditioner_ = rcp(new ProjectedPreconditioner(preconditioner_, coarseSpace_, penalty));
  }
}

/// Corrects M for the jumps of contact that it overrates, if there are any.
void DualProblem::correct() {
  if (parameters_.adaptiveConstraints.use == AdaptiveConstraintParameters::Use::no)
    return;
  const OverratedColumns columns =
      findOverratedColumns(problem_, *inverse_, JointKind::contact, parameters_.adaptiveConstraints,
                           parameters_.preconditioner.scaling);
  if (columns.number == 0)
    return;
  corrected_ =
      rcp(new CorrectedPreconditioner(*flexibility(), preconditioner_, columns, *inverse_->multiplierPlan()));
  preconditionerBytes_ += corrected_->bytes();
  preconditioner_ = corrected_;
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

} // namespace epafi::fetidp
