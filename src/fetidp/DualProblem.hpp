#pragma once

/// The problem in the multipliers, min ½λᵀFλ − λᵀd̃ with λ_I ≥ 0 (and Gλ = e where bodies float), and the
/// least algorithm that solves it:
///   no multiplier at all   direct solve, nothing to iterate
///   no contact             conjugate gradients on F (Belos)
///   contact, all supported MPRGP
///   floating bodies        SMALBE with MPRGP inside, on PFP after the shift by λ̃

#include "epafi/fetidp/DualOperator.hpp"
#include "epafi/fetidp/FetiParameters.hpp"
#include "epafi/fetidp/NaturalCoarseSpace.hpp"
#include "epafi/qp/MprgpParameters.hpp"
#include "epafi/qp/NormEstimate.hpp"
#include "epafi/qp/Smalbe.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <memory>
#include <string>

namespace epafi::fetidp {

enum class Algorithm { direct, conjugateGradient, mprgp, smalbe };

/// "Direct", "CG", "MPRGP", "SMALBE-M".
std::string toString(Algorithm algorithm);

struct DualParameters {
  double tolerance = 1e-6;            ///< on ‖g^P‖ relative to ‖d̃‖ or ‖Pd‖
  double equilibriumTolerance = 1e-6; ///< on ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes
  qp::MprgpParameters mprgp;
  qp::SmalbeParameters smalbe;
  qp::NormEstimateParameters norm;
  DualOperatorParameters dualOperator;
  PreconditionerParameters preconditioner;
};

/// λ and how it came about.
struct DualSolution {
  RCP<Vector> lambda; ///< on multiplierMap, λ_I ≥ 0
  double reference = 0; ///< ‖d̃‖ or ‖Pd‖, what residuals are relative to; the size of its terms if it vanishes
  double equilibrium = 0; ///< ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes
  qp::SolveReport report;
};

class DualProblem {
public:
  /// What depends on the matrices alone: F, G, the norm estimate. Keeps a reference to `problem`. Collective.
  DualProblem(const decomposition::DecomposedProblem& problem, std::shared_ptr<GeneralizedInverse> inverse,
              const DualParameters& parameters);

  [[nodiscard]] Algorithm algorithm() const { return algorithm_; }
  /// One sentence: why this algorithm.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] const qp::NormEstimate& norm() const { return norm_; }

  /// Solves for the loads and gaps that the problem holds now.
  /// \param start  λ to start from (a warm start), or null for 0
  /// \throws SolvabilityError (see Solvability.hpp), or InputError if a load or gap is not finite.
  /// Collective.
  DualSolution solve(const Vector* start, qp::Observer* observer);

  [[nodiscard]] RCP<const DualOperator> dualOperator() const { return dualOperator_; }
  /// M ≈ F⁻¹, or PMP + ρ⁻¹Q where bodies float; null without.
  [[nodiscard]] RCP<const Operator> preconditioner() const { return preconditioner_; }
  /// Bytes of this rank's blocks of M.
  [[nodiscard]] std::size_t preconditionerBytes() const { return preconditionerBytes_; }
  /// G, P, Q; null without floating bodies.
  [[nodiscard]] RCP<const NaturalCoarseSpace> coarseSpace() const { return coarseSpace_; }
  [[nodiscard]] const std::vector<KernelEntry>& kernelEntries() const { return kernelEntries_; }

private:
  void choose();
  void precondition();
  RCP<Vector> rightHandSide();
  RCP<Vector> lowerBounds(double free) const;
  void solveCoercive(const RCP<Vector>& rhs, const Vector* start, qp::Observer* observer,
                     DualSolution& solution);
  bool setReference(Vector& rhs, DualSolution& solution) const;
  void solveSemicoercive(const RCP<Vector>& rhs, const Eigen::VectorXd& resultants, const Vector* start,
                         qp::Observer* observer, DualSolution& solution);

  const decomposition::DecomposedProblem& problem_;
  std::shared_ptr<GeneralizedInverse> inverse_;
  DualParameters parameters_;
  Algorithm algorithm_ = Algorithm::direct;
  std::string reason_;
  RCP<const DualOperator> dualOperator_;
  std::vector<KernelEntry> kernelEntries_;
  RCP<const NaturalCoarseSpace> coarseSpace_;
  RCP<const Operator> hessian_;        ///< F or PFP
  RCP<const Operator> preconditioner_; ///< of the Hessian, or null
  std::size_t preconditionerBytes_ = 0;
  qp::NormEstimate norm_; ///< of the Hessian
  double termSize_ = 0;   ///< of the terms of d̃
};

/// The loads that the problem holds, f^s for each of this rank's subdomains.
SubdomainVectors loadsOf(const decomposition::DecomposedProblem& problem);

} // namespace epafi::fetidp
