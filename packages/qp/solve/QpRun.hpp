#pragma once

/// The inside of QpSolver::solve.

#include "epafi/qp/constraints/MatrixEquality.hpp"
#include "epafi/qp/operators/DeflatedOperator.hpp"
#include "epafi/qp/solve/QpSolver.hpp"

#include <string>

namespace epafi::qp {

/// One solve, step by step. A step that ends the solve returns false and leaves the status in the report.
struct QpSolver::Run {
  const QpSolver& solver;
  const QuadraticProgram& given;
  Vector& x;
  Observer* observer;
  QpSolution& solution;

  QuadraticProgram program;               ///< as the methods take it
  PreparedEquality rows{};                ///< of the matrix of constraints; empty without
  RCP<const DeflatedOperator> deflated{}; ///< null without a coarse space
  double reference = 0;
  int extraMultiplications = 0;

  void check() const;
  bool prepareConstraints();
  bool findStart();
  bool prepareOperators();
  void deflate();
  bool chooseReference();
  void iterate();
  void lookForUnboundedness();
  void undoDeflation();
  void completeGradient();
  void completeMultiplier(const Vector* ofLagrangian);
  void certifyBounds();
  void certifyRows();
  void judge();
  void certify();

  bool end(Status status, const std::string& reason) const {
    solution.report.status = status;
    solution.report.reason = reason;
    return false;
  }
};

} // namespace epafi::qp
