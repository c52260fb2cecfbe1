#pragma once

/// The problem in the multipliers, min ½λᵀFλ − λᵀd̃ with λ_I ≥ 0 (and Gλ = e where bodies float), and the
/// least algorithm that solves it:
///   no multiplier at all   direct solve, nothing to iterate
///   no contact             conjugate gradients on F (Belos)
///   contact, all supported MPRGP
///   floating bodies        SMALBE with MPRGP inside, on PFP after the shift by λ̃

#include "epafi/fetidp/CorrectedPreconditioner.hpp"
#include "epafi/fetidp/DeflatedDualOperator.hpp"
#include "epafi/fetidp/DualOperator.hpp"
#include "epafi/fetidp/ErrorBalance.hpp"
#include "epafi/fetidp/FetiParameters.hpp"
#include "epafi/fetidp/NaturalCoarseSpace.hpp"
#include "epafi/qp/MprgpParameters.hpp"
#include "epafi/qp/NormEstimate.hpp"
#include "epafi/qp/Smalbe.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <memory>
#include <string>

namespace epafi::fetidp {

class DualPreconditioner;

/// From the least to what bounds and floating bodies together need.
enum class Algorithm { direct, conjugateGradient, mprgp, smalbe };

/// "Direct", "CG", "MPRGP", "SMALBE-M".
std::string toString(Algorithm algorithm);

/// How the dual problem is solved, and how accurately.
struct DualParameters {
  double tolerance = 1e-6;            ///< on ‖g^P‖ relative to ‖d̃‖ or ‖Pd‖
  bool isBalanced = false;            ///< in its place: the algebraic error against the discretisation error
  double equilibriumTolerance = 1e-6; ///< on ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes
  qp::MprgpParameters mprgp;
  qp::SmalbeParameters smalbe;
  qp::NormEstimateParameters norm;
  DualOperatorParameters dualOperator;
  PreconditionerParameters preconditioner;
  AdaptiveConstraintParameters adaptiveConstraints;
};

/// What a solve stops at.
struct DualGoal {
  const ErrorBalance* balance = nullptr; ///< if the parameters ask for balance
  double tightening = 1;                 ///< factor on the tolerance, ≤ 1
};

/// λ and how it came about.
struct DualSolution {
  RCP<Vector> lambda; ///< on multiplierMap, λ_I ≥ 0
  /// ‖d̃‖ or ‖Pd‖, with Pᵀd̃ for d̃ where jumps are deflated: what residuals are relative to; the size of its terms if it
  /// vanishes.
  double reference = 0;
  double errorTarget = 0; ///< with an ErrorBalance: the algebraic error that was small enough; else 0
  double equilibrium = 0; ///< ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes
  qp::SolveReport report;
};

class DualProblem {
public:
  /// What depends on the matrices alone: F, G, the norm estimate. Keeps a reference to `problem`. Collective.
  DualProblem(const decomposition::DecomposedProblem& problem, std::shared_ptr<GeneralizedInverse> inverse,
              const DualParameters& parameters);

  [[nodiscard]] Algorithm algorithm() const { return algorithm_; } ///< the least that will do
  /// One sentence: why this algorithm.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Of the Hessian.
  [[nodiscard]] const qp::NormEstimate& norm() const { return norm_; }

  /// Solves for the loads and gaps that the problem holds now.
  /// \param start  λ to start from (a warm start), or null for 0
  /// \param observer  told of every step, shown λ where it wants to look; or null
  /// \throws SolvabilityError (see Solvability.hpp; also if the iteration proves that contact rows contradict each other),
  ///         or InputError if a load or gap is not finite.
  /// Collective.
  DualSolution solve(const Vector* start, qp::Observer* observer, const DualGoal& goal = {});

  /// λ of a guess of the displacements, to start from: Eᵀ(f − Ku), forces of contact that pull left out. Null without a
  /// preconditioner of type dirichlet, which it takes.
  /// \param displacement  u at all positions of each of this rank's subdomains, in space; what counts are the nodes that
  ///                      subdomains share or contact touches
  /// Collective.
  [[nodiscard]] RCP<Vector> startFrom(std::span<const Eigen::VectorXd> displacement) const;

  [[nodiscard]] RCP<const DualOperator> dualOperator() const { return dualOperator_; } ///< F
  /// M ≈ F⁻¹, or PMP + ρ⁻¹Q where bodies float; null without.
  [[nodiscard]] RCP<const Operator> preconditioner() const { return preconditioner_; }
  /// Bytes of this rank's blocks of M.
  [[nodiscard]] std::size_t preconditionerBytes() const { return preconditionerBytes_; }
  /// What the iteration works on: F, F_U with adaptive constraints, or either of them between projectors P.
  [[nodiscard]] RCP<const Operator> hessian() const { return hessian_; }
  /// F with adaptive constraints; null where there are none.
  [[nodiscard]] RCP<const DeflatedDualOperator> deflatedOperator() const { return deflated_; }
  /// The preconditioner where it is corrected for jumps of contact; else null.
  [[nodiscard]] RCP<const CorrectedPreconditioner> correctedPreconditioner() const { return corrected_; }
  /// G, P, Q; null without floating bodies.
  [[nodiscard]] RCP<const NaturalCoarseSpace> coarseSpace() const { return coarseSpace_; }
  /// G̃ᵀ by rows, this rank's.
  [[nodiscard]] const std::vector<KernelEntry>& kernelEntries() const { return kernelEntries_; }

private:
  void choose();
  void precondition();
  void deflate();
  void correct();
  [[nodiscard]] RCP<const Operator> flexibility() const;
  RCP<Vector> rightHandSide();
  void completeJumps(Vector& lambda) const;
  RCP<Vector> lowerBounds(double free) const;
  void solveCoercive(const RCP<Vector>& rhs, const Vector* start, qp::Observer* observer,
                     const ErrorBalance* balance, DualSolution& solution);
  bool setReference(Vector& rhs, DualSolution& solution) const;
  void solveSemicoercive(const RCP<Vector>& rhs, const Eigen::VectorXd& resultants, const Vector* start,
                         qp::Observer* observer, const ErrorBalance* balance, DualSolution& solution);

  const decomposition::DecomposedProblem& problem_;
  std::shared_ptr<GeneralizedInverse> inverse_;
  DualParameters parameters_;
  Algorithm algorithm_ = Algorithm::direct;
  std::string reason_;
  RCP<const DualOperator> dualOperator_;
  RCP<const DeflatedDualOperator> deflated_;     ///< null where no jump is deflated
  RCP<const CorrectedPreconditioner> corrected_; ///< null where no jump of contact is overrated
  RCP<const Vector> wholeRhs_;                   ///< d̃ of the present solve, before it was deflated
  std::vector<KernelEntry> kernelEntries_;
  RCP<const NaturalCoarseSpace> coarseSpace_;
  RCP<const Operator> hessian_;             ///< F or PFP, or F_U for F
  RCP<const Operator> preconditioner_;      ///< of the Hessian, or null
  RCP<const DualPreconditioner> dirichlet_; ///< of F, or null
  std::size_t preconditionerBytes_ = 0;
  qp::NormEstimate norm_; ///< of the Hessian
  double termSize_ = 0;   ///< of the terms of d̃
  double tolerance_ = 0;  ///< of the present solve
};

/// The loads that the problem holds, f^s for each of this rank's subdomains.
SubdomainVectors loadsOf(const decomposition::DecomposedProblem& problem);

} // namespace epafi::fetidp
