#pragma once

/// Dense quadratic programs for QpSolver on any number of ranks, and its answers back as dense data on every
/// rank.

#include "support/DenseProgram.hpp"
#include "support/Problems.hpp"

#include "epafi/qp/solve/QpSolver.hpp"

#include <Teuchos_ParameterList.hpp>

#include <functional>
#include <limits>
#include <string>

namespace epafi::test {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

struct QpAnswer {
  Eigen::VectorXd x, boundMultiplier, equalityMultiplier; ///< empty where the solver gave none
  Eigen::VectorXd certificate;
  qp::SolveReport report;
  int products = 0; ///< with the dense Hessian, those of the norm estimate and of set-up included
};

/// How a dense program is handed over.
struct QpCall {
  Teuchos::ParameterList parameters = Teuchos::ParameterList();
  Eigen::VectorXd start = {}; ///< 0 if empty
  qp::Observer* observer = nullptr;
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  /// Last changes to the problem, such as a preconditioner or another operator.
  std::function<void(qp::QuadraticProgram&)> change = {};
};

/// The program as QpSolver takes it; bounds are left out where no entry has one, B where it has no rows.
qp::QuadraticProgram toQuadraticProgram(const DenseProgram& program,
                                        const RCP<const Comm>& comm = Tpetra::getDefaultComm());

QpAnswer solveQp(const DenseProgram& program, const QpCall& call = {});

/// 'Tolerance' and 'Constraint Tolerance' alike.
Teuchos::ParameterList withTolerance(double tolerance);

/// Compares an answer that says it converged with the dense data: feasible, KKT residuals recomputed within
/// `tolerance` and as reported, multipliers with the right signs. Empty if all is well, else what is not.
/// Where b = 0 the gradients are compared with ‖A‖‖x‖.
std::string whyNoSolution(const DenseProgram& program, const QpAnswer& answer, double tolerance);

/// l, u, b, A without equality rows: two-sided, lower, upper, no bounds and fixed entries in turn; A of norm
/// 1.
DenseProgram mixedProgram(int n, double condition, unsigned seed);
/// The same with m random rows that a point inside the bounds satisfies.
DenseProgram mixedProgramWithRows(int n, int m, double condition, unsigned seed);

} // namespace epafi::test
