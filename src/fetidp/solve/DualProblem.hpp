#pragma once

/// The problem in the multipliers, min ½λᵀFλ − λᵀd̃ with λ_I ≥ 0 (and Gλ = e where bodies float): the plan of
/// its solves (Plan.hpp), what they work on (DualOperators.hpp), and the solves.

#include "epafi/fetidp/equilibrium/FeasibleForces.hpp"
#include "epafi/fetidp/solve/DualOperators.hpp"
#include "epafi/fetidp/solve/ErrorBalance.hpp"
#include "epafi/qp/solve/SolveReport.hpp"

#include <memory>
#include <span>
#include <vector>

namespace epafi::fetidp {

/// λ and how it came about.
struct DualSolution {
  RCP<Vector> lambda; ///< on multiplierMap, λ_I ≥ 0
  /// ‖d̃‖ or ‖Pd‖, with Pᵀd̃ for d̃ where jumps are deflated: what residuals are relative to; the size of its
  /// terms if it vanishes.
  double reference = 0;
  double errorTarget = 0;   ///< with an ErrorBalance: the algebraic error that was small enough; else 0
  bool isEstimated = false; ///< the last answer of ErrorBalance::estimate was for this λ
  double equilibrium = 0;   ///< ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes
  qp::SolveReport report;
};

class DualProblem {
public:
  /// What depends on the matrices alone: F, G, the norm estimate. Keeps a reference to `problem`. Collective.
  /// \param data  for the sentences of refusals alone
  DualProblem(const decomposition::DecomposedProblem& problem, const decomposition::ProblemData& data,
              const std::shared_ptr<GeneralizedInverse>& inverse, const DualParameters& parameters,
              const RunFacts& run = {});

  [[nodiscard]] const Plan& plan() const { return plan_; } ///< by all facts, those of the operators too
  [[nodiscard]] const PlanFacts& facts() const { return facts_; }       ///< those
  [[nodiscard]] Algorithm algorithm() const { return plan_.algorithm; } ///< the plan's
  /// Of the Hessian.
  [[nodiscard]] const qp::NormEstimate& norm() const { return operators_.norm; }

  /// \param data   loads, prescribed values and gaps
  /// \param start  λ to start from (a warm start), or null for 0
  /// \param observer  told of every step, shown λ where it wants to look; or null
  /// \param balance   if the parameters ask for balance
  /// \throws SolvabilityError (see Solvability.hpp; also if the iteration proves that contact rows contradict
  /// each other), or InputError if a load or gap is not finite. Collective.
  DualSolution solve(const decomposition::ProblemData& data, const Vector* start, qp::Observer* observer,
                     const ErrorBalance* balance = nullptr) const;

  /// λ of a guess of the displacements, to start from: Eᵀ(f − Ku), forces of contact that pull left out. Null
  /// without a preconditioner of type dirichlet, which it takes.
  /// \param displacement  u at all positions of each of this rank's subdomains, in space; what counts are the
  /// nodes that subdomains share or contact touches
  /// Collective.
  [[nodiscard]] RCP<Vector> startFrom(const decomposition::ProblemData& data,
                                      std::span<const Eigen::VectorXd> displacement) const;

  /// What multipliers may be.
  /// \param normal  where Coulomb's bounds take their normal forces from
  [[nodiscard]] RCP<const qp::ConvexSet> feasibleForces(const decomposition::ProblemData& data,
                                                        const Vector& normal) const {
    return fetidp::feasibleForces(problem_, data, &normal);
  }
  /// What it was made of.
  [[nodiscard]] const decomposition::DecomposedProblem& problem() const { return problem_; }
  [[nodiscard]] const GeneralizedInverse& inverse() const { return *inverse_; }  ///< K̄⁺
  [[nodiscard]] const DualParameters& parameters() const { return parameters_; } ///< as given
  [[nodiscard]] const DualOperators& operators() const {
    return operators_;
  } ///< F, P, M and what goes with them
  [[nodiscard]] RCP<const DualOperator> dualOperator() const { return operators_.f; } ///< F
  /// M ≈ F⁻¹, or PMP + ρ⁻¹Q where bodies float; null without.
  [[nodiscard]] RCP<const Operator> preconditioner() const { return operators_.preconditioner; }
  /// Bytes of this rank's blocks of M.
  [[nodiscard]] std::size_t preconditionerBytes() const { return operators_.preconditionerBytes(); }
  /// What the iteration works on: F, F_U with adaptive constraints, or either of them between projectors P.
  [[nodiscard]] RCP<const Operator> hessian() const { return operators_.hessian; }
  /// F with adaptive constraints; null where there are none.
  [[nodiscard]] RCP<const qp::DeflatedOperator> deflatedOperator() const { return operators_.deflated; }
  /// G, P, Q; null without floating bodies.
  [[nodiscard]] RCP<const NaturalCoarseSpace> coarseSpace() const { return operators_.coarseSpace; }
  /// G̃ᵀ by rows, this rank's.
  [[nodiscard]] const std::vector<KernelEntry>& kernelEntries() const { return kernelEntries_; }

private:
  const decomposition::DecomposedProblem& problem_;
  const std::shared_ptr<const GeneralizedInverse> inverse_;
  const DualParameters parameters_;
  const std::vector<KernelEntry> kernelEntries_;
  PlanFacts facts_;
  Plan plan_;
  const DualOperators operators_;
};

} // namespace epafi::fetidp
