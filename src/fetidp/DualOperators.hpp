#pragma once

/// Which algorithm solves the problem in the multipliers, and what its iteration works on, made of the
/// matrices alone: F, deflated by adaptive constraints, between projectors where bodies float, its norm, and
/// its preconditioner.

#include "epafi/fetidp/CorrectedPreconditioner.hpp"
#include "epafi/fetidp/DualOperator.hpp"
#include "epafi/fetidp/DualPreconditioner.hpp"
#include "epafi/fetidp/FetiParameters.hpp"
#include "epafi/fetidp/NaturalCoarseSpace.hpp"
#include "epafi/qp/DeflatedOperator.hpp"
#include "epafi/qp/MprgpParameters.hpp"
#include "epafi/qp/NormEstimate.hpp"
#include "epafi/qp/Smalbe.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::fetidp {

/// From the least to what bounds and floating bodies together need:
///   no multiplier at all   direct solve, nothing to iterate
///   no contact             conjugate gradients on F (Belos)
///   contact, all supported MPRGP
///   floating bodies SMALBE with MPRGP inside, on PFP after the shift by λ̃; or active sets, with Gλ = e held
///   exactly
enum class Algorithm { direct, conjugateGradient, mprgp, smalbe, activeSets };

/// "Direct", "CG", "MPRGP", "SMALBE-M", "Active sets".
std::string toString(Algorithm algorithm);

struct AlgorithmChoice {
  Algorithm algorithm = Algorithm::direct;
  std::string reason; ///< one sentence
};

/// The least that solves the problem in the multipliers. Not collective; the same on all ranks.
AlgorithmChoice leastAlgorithm(const decomposition::DecomposedProblem& problem);

/// How the dual problem is solved, and how accurately.
struct DualParameters {
  /// Of problems with contact: active sets where bodies float and there is a preconditioner; MPRGP or SMALBE;
  /// active sets.
  enum class Method { automatic, mprgp, activeSets };
  Method method = Method::automatic;
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

/// The least, or active sets in its place where the parameters say so. Likewise.
AlgorithmChoice chosenAlgorithm(const decomposition::DecomposedProblem& problem,
                                const DualParameters& parameters);

/// Where there is nothing to iterate, all are null.
struct DualOperators {
  RCP<const DualOperator> f;                        ///< F
  RCP<const qp::DeflatedOperator> deflated;         ///< F_U; null where no jump is deflated
  RCP<const NaturalCoarseSpace> coarseSpace;        ///< G, P, Q; null without floating bodies
  RCP<const Operator> hessian;                      ///< F or F_U, or either of them between projectors P
  qp::NormEstimate norm;                            ///< of the Hessian, where it is needed
  RCP<const DualPreconditioner> dualPreconditioner; ///< M ≈ F⁻¹; null without
  RCP<const CorrectedPreconditioner> corrected;     ///< of M; null where no jump of contact is overrated
  bool hasDependentRows =
      false; ///< some have no unknown of their own (SharedRows.hpp), and M says nothing of their multipliers
  RCP<const Operator> facePreconditioner; ///< M with all corrections, between no projectors; or null
  RCP<const Operator> preconditioner;     ///< of the Hessian, or null
  qp::MprgpParameters mprgp;              ///< as given, what was left open decided

  /// F_U, or F without adaptive constraints.
  [[nodiscard]] RCP<const Operator> flexibility() const;
  /// Bytes of this rank's part of the preconditioner.
  [[nodiscard]] std::size_t preconditionerBytes() const;
};

/// \param data           for the sentences of refusals alone
/// \param inverse        gets the dense blocks that the parameters ask for
/// \param kernelEntries  see kernelConstraint
/// Collective. \throws SolvabilityError if a floating body meets no contact, Error if a factorisation fails.
DualOperators makeDualOperators(const decomposition::DecomposedProblem& problem,
                                const decomposition::ProblemData& data, Algorithm algorithm,
                                const std::shared_ptr<GeneralizedInverse>& inverse,
                                const std::vector<KernelEntry>& kernelEntries,
                                const DualParameters& parameters);

} // namespace epafi::fetidp
