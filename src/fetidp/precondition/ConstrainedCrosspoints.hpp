#pragma once

/// How a body follows the crosspoints that contact moves (ContactCrosspoints.hpp) if it keeps adaptive
/// constraints: with the least energy of all displacements with UᵀB w = 0. Without them a crosspoint's motion
/// tears apart what the constraints hold together, and the preconditioner, which mends it edge by edge,
/// overrates that motion.
///
/// Forces at these crosspoints cause the jumps D⁰ = (J + B_C) Ŝ⁻¹, and with the constraints
///   D = P_Uᵀ D⁰,   Ŝ_U⁻¹ = Ŝ⁻¹ − D⁰ᵀU(UᵀFU)⁻¹UᵀD⁰,   J_U = D Ŝ_U − B_C .

#include "epafi/base/AccurateSum.hpp"
#include "epafi/qp/operators/ColumnSpace.hpp"

#include <Eigen/Core>

#include <span>

namespace epafi::fetidp {

/// n_C crosspoint values. Memory: n_λ n_C numbers shared by the ranks.
class ConstrainedCrosspoints {
public:
  /// \param space          U beside F
  /// \param jumps          J, n_λ × n_C: jumps of the boundaries that follow each crosspoint value
  /// \param atCrosspoints  B_C, n_λ × n_C: entries of B at these crosspoint values
  /// \param stiffness      Ŝ, n_C × n_C, on every rank
  /// \throws Error if Ŝ_U⁻¹ is not positive definite. Collective.
  ConstrainedCrosspoints(const qp::ColumnSpace& space, const MultiVector& jumps,
                         const MultiVector& atCrosspoints, const Eigen::MatrixXd& stiffness);

  /// Ŝ_U, on every rank.
  [[nodiscard]] const Eigen::MatrixXd& stiffness() const { return stiffness_; }
  /// y = −J_U u, u: n_C × k. Not collective.
  void negativeJumps(const Eigen::MatrixXd& u, MultiVector& y) const;
  /// sums −= J_Uᵀ r, this rank's part, n_C × k. Not collective.
  void subtractForces(const MultiVector& r, std::span<AccurateSum> sums) const;

private:
  Eigen::MatrixXd jumps_, stiffness_; ///< J_U, this rank's rows; Ŝ_U
};

} // namespace epafi::fetidp
