#pragma once

/// A convex quadratic program in operators, as every method of this package takes it.

#include "epafi/qp/constraints/ConvexSet.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"

#include <functional>
#include <string>

namespace epafi::qp {

/// min ½xᵀAx − bᵀx subject to x in Ω and Bx = c. Everything is shared and never changed. Members that a
/// problem has no use for stay null. Vectors are on A's domain map, that of x.
struct QuadraticProgram {
  RCP<const Operator> hessian{};  ///< A, n × n, symmetric positive semidefinite
  RCP<const Vector> linearTerm{}; ///< b
  RCP<const ConvexSet> set{};     ///< Ω; null: everything
  /// Where Ω depends on x itself, as Coulomb's friction does on the normal forces: Ω(x); x is then to be in
  /// Ω(x), and `set` is what the iteration begins with. It is by active sets then, whatever the method.
  std::function<RCP<const ConvexSet>(const Vector& x)> setAt = {};
  /// What is said where no x in Ω(x) is found.
  std::string unsettled = "the set that depends on the solution does not settle: there may be several "
                          "solutions, or none";
  RCP<const EqualityConstraint> equality{}; ///< Bx = c
  RCP<const Operator> preconditioner{}; ///< M ≈ A⁻¹, symmetric positive definite; restricted to faces
  /// Makes M for the face of the start: given 1 for every free entry and 0 for those at a bound. Called once
  /// a solve, on all ranks; takes the place of `preconditioner`.
  std::function<RCP<const Operator>(const Vector& freeIndicator)> facePreconditioner = {};
  double operatorNorm = 0; ///< over-estimate of ‖A‖ on Ker B (estimateNorm); 0: unknown, or A = 0
  /// What takes the place of A and M in methods that hold Bx = 0 by a penalty ρ, or not at all: the same on
  /// Ker B, and beside it what suits them, as PAP and PMP + ρ⁻¹(I − P). Null: A and M.
  RCP<const Operator> hessianOnKernel{}, preconditionerOnKernel{};

  /// What follows is for QpSolver alone, which makes a program without of it.
  RCP<const Operator>
      constraintMatrix{}; ///< B, m × n, of any rank, with a transposed apply (a CrsMatrix has one)
  RCP<const Vector> constraintValues{}; ///< c, on B's range map; null for 0
  /// Columns U of a coarse space for projector preconditioning; 0 in every entry that has a bound.
  RCP<const MultiVector> coarseSpace{};
  /// Not 0 for entries that are expected at a bound: the start is moved there.
  RCP<const Vector> activeGuess{};

  /// The program of y = x − point: b − A point, Ω − point, and Ω(x) likewise. Of equations it has none: with
  /// B point = c, By = 0 is left to be set. One product. Collective.
  [[nodiscard]] QuadraticProgram shiftedBy(const RCP<const Vector>& point) const;
  /// With A and M on Ker B. Not collective.
  [[nodiscard]] QuadraticProgram onKernel() const;
};

} // namespace epafi::qp
