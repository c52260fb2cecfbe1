#pragma once

/// Jumps between subdomains that the preconditioner overrates, of all joints (Joints.hpp), found where the
/// stiffness jumps within a subdomain: along each joint a generalised eigenproblem shows them
/// (JointStiffness.hpp). Jumps of gluing become *adaptive constraints*, enforced by deflation
/// (qp/DeflatedOperator.hpp), so that neither the decomposition nor the coarse problem knows of them: with
/// all ω below τ, κ(MF) ≤ N² τ where no contact is, N the most joints of a subdomain (Klawonn, Radtke,
/// Rheinbach, *ETNA* 45 (2016)). Jumps of contact cannot be constrained, for contact may open; they correct
/// the preconditioner (CorrectedPreconditioner.hpp).

#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
#include "epafi/fetidp/precondition/Joints.hpp"
#include "epafi/qp/operators/ColumnSpace.hpp"

#include <vector>

namespace epafi::fetidp {

/// Columns, n_λ × k, each with entries in the rows of one joint: M_E y for joints of gluing; y itself for
/// those of contact, whose M_E says not all of M: crosspoints that contact moves act on it as well.
struct OverratedColumns {
  struct Entry {
    int row; ///< local index in multiplierGhostMap
    int column;
    double value;
  };
  int number = 0;             ///< k, the same on all ranks
  std::vector<Entry> entries; ///< this rank's; each entry is on one rank
  double largestRatio = 0;    ///< ω of the worst
  int numJoints = 0;          ///< whose eigenproblems were solved
};

/// Costs, where a joint of n_E rows is looked at: S_ΔΔ and its inverse of its subdomains, which `inverse`
/// keeps, a message of about 2 n_E² numbers from each of them but the first, and a dense eigenproblem of size
/// n_E. The same on any number of ranks. Collective.
/// \throws Error if round-off has spoilt a joint's matrices, the same on all ranks.
OverratedColumns findOverratedColumns(const decomposition::DecomposedProblem& problem,
                                      GeneralizedInverse& inverse, RowKind kind, const JumpSearch& search,
                                      PreconditionerParameters::Scaling scaling);

/// U beside A: the columns themselves, or M times them. Costs a product with A for each, and with M, 32 at
/// once.
///
/// Columns of gluing have no entries in rows of contact, so that bounds are not touched. Rigid motions of a
/// cluster keep it glued, and between clusters columns are chosen in equilibrium, so that GU = 0 and GP = G:
/// λ = Pμ + U(UᵀFU)⁻¹Uᵀd̃ is in equilibrium if μ is, and PᵀFP is the dual operator of the displacements with
/// UᵀBu = 0 (Klawonn, Rheinbach, *ZAMM* 92 (2012)).
/// \param plan  from multiplierMap to multiplierGhostMap
/// \param m     null: the columns themselves
/// \throws Error if UᵀAU is not positive definite. Collective.
qp::ColumnSpace spaceOf(const OverratedColumns& columns, const Import& plan, const Operator& a,
                        const Operator* m = nullptr);

} // namespace epafi::fetidp
