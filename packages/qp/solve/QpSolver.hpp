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
/// It checks and prepares what is given (rows, start, norm, reference), solves (Solve.hpp), and certifies.

#include "epafi/qp/operators/NormEstimate.hpp"
#include "epafi/qp/solve/QuadraticProgram.hpp"
#include "epafi/qp/solve/Solve.hpp"

#include <Teuchos_Describable.hpp>
#include <Teuchos_ParameterList.hpp>

#include <optional>
#include <string>

namespace epafi::qp {

/// What a solve returns beside x.
struct QpSolution {
  SolveReport report;
  RCP<Vector> boundMultiplier;    ///< Ax − b + Bᵀμ where a bound holds x (≥ 0 at a lower one), else 0
  RCP<Vector> equalityMultiplier; ///< μ on the rows of B; null without a matrix. Redundant rows share it
};

class QpSolver : public Teuchos::Describable {
public:
  /// All parameters with defaults, ranges and meaning.
  static Teuchos::ParameterList validParameters();

  /// \throws InputError if the list is not valid. Not collective.
  explicit QpSolver(const Teuchos::ParameterList& parameters = Teuchos::ParameterList());

  /// Says `converged` only if the KKT residuals, recomputed, bear it out. A problem without a solution is
  /// named in the status (infeasible, unbounded, indefiniteOperator), with a certificate.
  /// \param x         in: start, any finite vector; out: the last iterate, within the bounds and finite
  /// \param observer  told of every step; may be null
  /// \throws InputError, on all ranks alike, if vectors do not fit or data are not finite. Collective.
  QpSolution solve(const QuadraticProgram& problem, Vector& x, Observer* observer = nullptr);

  [[nodiscard]] std::string description() const override;

private:
  struct Run; ///< one solve, in QpRun.hpp

  double tolerance_, absoluteTolerance_, constraintTolerance_, reference_, operatorNorm_;
  int maxDenseRows_;
  std::optional<Method> method_; ///< none: chosen
  SolveParameters methods_;
  NormEstimateParameters norm_;
  std::string lastRun_ = "not run yet";
};

} // namespace epafi::qp
