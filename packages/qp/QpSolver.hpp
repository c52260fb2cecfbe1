#pragma once

/// Convex quadratic programming over Tpetra operators, taken alone:
///
///     QuadraticProgram problem;
///     problem.hessian = a;        // symmetric positive semidefinite
///     problem.linearTerm = b;
///     problem.set = rcp(new Box(lower, upper));
///     QpSolver solver(parameters);
///     QpSolution solution = solver.solve(problem, x);
///     if (solution.report.status != Status::converged) std::cerr << solution.report.reason;
///
/// Bounds only, or none: MPRGP. Equality constraints: SMALBE with MPRGP inside.

#include "epafi/qp/ConvexSet.hpp"
#include "epafi/qp/MprgpParameters.hpp"
#include "epafi/qp/NormEstimate.hpp"
#include "epafi/qp/Smalbe.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <Teuchos_Describable.hpp>
#include <Teuchos_ParameterList.hpp>

#include <functional>
#include <string>

namespace epafi::qp {

/// min ½xᵀAx − bᵀx subject to x in Ω and Bx = c. Everything is shared and never changed. Members that a
/// problem has no use for stay null.
struct QuadraticProgram {
  RCP<const Operator> hessian;  ///< A, n × n, symmetric positive semidefinite; its domain map is that of x
  RCP<const Vector> linearTerm; ///< b
  RCP<const ConvexSet> set;     ///< Ω
  RCP<const Operator>
      constraintMatrix; ///< B, m × n, of any rank, with a transposed apply (a CrsMatrix has one)
  RCP<const Vector> constraintValues; ///< c, on B's range map; null for 0

  /// M ≈ A⁻¹, symmetric positive definite; used restricted to the free set.
  RCP<const Operator> preconditioner;
  /// Makes M for the face of the start: given 1 for every free entry and 0 for those at a bound. Called once
  /// a solve, on all ranks; takes the place of `preconditioner`.
  std::function<RCP<const Operator>(const Vector& freeIndicator)> facePreconditioner;
  /// Columns U of a coarse space for projector preconditioning; 0 in every entry that has a bound.
  RCP<const MultiVector> coarseSpace;
  /// Not 0 for entries that are expected at a bound: the start is moved there.
  RCP<const Vector> activeGuess;
};

/// What a solve returns beside x.
struct QpSolution {
  SolveReport report;
  RCP<Vector> boundMultiplier;    ///< Ax − b + Bᵀμ where a bound holds x (≥ 0 at a lower one), else 0
  RCP<Vector> equalityMultiplier; ///< μ on the rows of B; null without. Redundant rows share it
};

class QpSolver : public Teuchos::Describable {
public:
  /// All parameters with defaults, ranges and meaning.
  static Teuchos::ParameterList validParameters();

  /// \throws InputError if the list is not valid. Not collective.
  explicit QpSolver(const Teuchos::ParameterList& parameters = Teuchos::ParameterList());

  /// \param x  in: start, any finite vector; out: the last iterate, within the bounds and finite
  /// \param observer  told of every step; may be null Says `converged` only if the KKT residuals, recomputed,
  /// bear it out. A problem without a solution is named in the status (infeasible, unbounded,
  /// indefiniteOperator), with a certificate.
  /// \throws InputError, on all ranks alike, if vectors do not fit or data are not finite. Collective.
  QpSolution solve(const QuadraticProgram& problem, Vector& x, Observer* observer = nullptr);

  [[nodiscard]] std::string description() const override;

private:
  struct Run; ///< one solve, in QpRun.hpp

  double tolerance_, absoluteTolerance_, constraintTolerance_, reference_, operatorNorm_;
  int maxDenseRows_;
  MprgpParameters mprgp_;
  SmalbeParameters smalbe_;
  NormEstimateParameters norm_;
  std::string lastRun_ = "not run yet";
};

} // namespace epafi::qp
