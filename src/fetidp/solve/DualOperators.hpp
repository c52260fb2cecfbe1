#pragma once

/// What the iteration on the multipliers works on, made of the matrices alone: F, deflated by adaptive
/// constraints, between projectors where bodies float, its norm, and its preconditioner.

#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"
#include "epafi/fetidp/operator/DualOperator.hpp"
#include "epafi/fetidp/precondition/CorrectedPreconditioner.hpp"
#include "epafi/fetidp/precondition/DualPreconditioner.hpp"
#include "epafi/fetidp/solve/Plan.hpp"
#include "epafi/qp/operators/DeflatedOperator.hpp"
#include "epafi/qp/operators/NormEstimate.hpp"

#include <memory>
#include <vector>

namespace epafi::fetidp {

/// Where there is nothing to iterate, all are null.
struct DualOperators {
  RCP<const DualOperator> f;                        ///< F, with C where contacts give way
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
                                const decomposition::ProblemData& data, const Plan& plan,
                                const std::shared_ptr<GeneralizedInverse>& inverse,
                                const std::vector<KernelEntry>& kernelEntries,
                                const DualParameters& parameters);

} // namespace epafi::fetidp
