#pragma once

/// What a joint looks like from its subdomains: the flexibility F_E with which they resist a jump y along it,
/// and the stiffness M_E that the preconditioner answers with. Where yᵀM_E y is far above yᵀF_E⁻¹y, the least
/// energy of a displacement that jumps by y, the two disagree, and y is a jump that should not be left to the
/// iteration.
///
/// F_E⁻¹ is the stiffness of the joint's subdomains, their crosspoints joined and all else free, condensed to
/// y = B_E w; M_E is the diagonal block of the preconditioner M. Mandel, Sousedík, *Comput. Methods Appl.
/// Mech. Engrg.* 196 (2007); Klawonn, Radtke, Rheinbach, *SIAM J. Numer. Anal.* 53 (2015); in the form of
/// Pechstein, Dohrmann, *ETNA* 46 (2017).

#include "epafi/fetidp/operator/CondensedSubdomain.hpp"
#include "epafi/fetidp/operator/FetiParameters.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace epafi::fetidp {

/// What one subdomain contributes to a joint of n_E rows; n_c crosspoint values.
struct JointPart {
  JointPart(int number, int ofCluster, Eigen::Index numRows, Eigen::Index numCrosspoints,
            Eigen::Index numMotions); ///< all 0

  int subdomain;                                        ///< its number
  int cluster;                                          ///< that of its cluster
  std::vector<decomposition::CoarseNumber> crosspoints; ///< coarse index of each crosspoint value
  Eigen::MatrixXd flexibility;                          ///< B_E S_ΔΔ⁻¹ B_Eᵀ, n_E × n_E
  Eigen::MatrixXd response;                             ///< B_E Ψ_Δ, n_E × n_c
  Eigen::MatrixXd crosspointStiffness;                  ///< S, n_c × n_c
  Eigen::VectorXd crosspointDiagonal;                   ///< diag K_cc, n_c
  Eigen::MatrixXd weightedStiffness; ///< B_E D⁻¹ S_ΔΔ D⁻¹ B_Eᵀ, n_E × n_E, D the weights of the scaling
  Eigen::VectorXd weights;           ///< Σ b²/δ of each row, n_E
  Eigen::MatrixXd motions;           ///< B_E R, n_E × the rigid motions of its cluster
};

/// \param cluster  of the subdomain
/// \param rows  the joint's rows, local indices in multiplierGhostMap; the subdomain must touch each. Not
/// collective.
JointPart partOf(const decomposition::Subdomain& subdomain, int cluster, const CondensedSubdomain& condensed,
                 const CondensedBoundary& boundary, std::span<const int> rows,
                 PreconditionerParameters::Scaling scaling);

/// Puts a part of the joint with a first row (global index) at the end of a message.
void pack(GlobalOrdinal firstRow, const JointPart& part, std::vector<std::byte>& message);
/// Takes first row and part off the front of `message`.
std::pair<GlobalOrdinal, JointPart> unpack(std::span<const std::byte>& message);

/// F_E = `ofBoundaries` + R Rᵀ and M_E, n_E × n_E, symmetric positive definite.
struct JointStiffness {
  Eigen::MatrixXd ofBoundaries;   ///< Σ B_E S_ΔΔ⁻¹ B_Eᵀ
  Eigen::MatrixXd preconditioner; ///< M_E
  Eigen::MatrixXd response;       ///< R: how the joint follows its crosspoints, n_E × any number

  [[nodiscard]] Eigen::MatrixXd flexibility() const { return ofBoundaries + response * response.transpose(); }
};

/// Adds the parts up in the order given. Where the subdomains are a mechanism F_E is infinite: springs of
/// 10⁻¹² times the stiffness there, or of the size of round-off, hold the crosspoints, so that F_E is just
/// large. Not collective.
JointStiffness joined(const std::vector<JointPart>& parts);

/// The joint's rows of Gᵀ, n_E × the rigid motions of its clusters; no column where all subdomains are of one
/// cluster, whose motions jump nowhere. Not collective.
Eigen::MatrixXd motionsOf(const std::vector<JointPart>& parts);

/// Jumps that M overrates: all y with M_E y = ω F_E⁻¹ y, ω > threshold, made of length 1 in M_E, and u = M_E
/// y. A constraint uᵀB_E w = 0 takes y out of the iteration, and with all of them yᵀM_E y ≤ threshold ·
/// yᵀF_E⁻¹y for what is left.
struct OverratedJumps {
  Eigen::VectorXd ratios; ///< ω, descending
  Eigen::MatrixXd jumps;  ///< y, n_E × k, in the same order
  Eigen::MatrixXd forces; ///< u = M_E y, likewise
};

/// \param motions  columns to which u is to be orthogonal, n_E × any number: the eigenproblem is that of such
/// u Costs n_E³/3 operations for a joint without any, about 10 n_E³ for others. \throws Error if M_E is not
/// positive definite.
/// Not collective.
OverratedJumps overratedJumps(const JointStiffness& joint, double threshold,
                              const Eigen::MatrixXd& motions = {});

} // namespace epafi::fetidp
