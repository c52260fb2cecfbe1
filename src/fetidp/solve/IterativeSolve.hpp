#pragma once

/// One solve of the dual problem that iterates.

#include "epafi/fetidp/solve/DualObservers.hpp"
#include "epafi/fetidp/solve/DualProblem.hpp"
#include "epafi/qp/solve/Solve.hpp"

#include <optional>

namespace epafi::fetidp {

/// A right-hand side, and what it is the difference of.
struct RightHandSide {
  RCP<Vector> values;
  double termSize = 0; ///< max |K̄⁺f̄| + max |c|
  double largest = 0;  ///< max |K̄⁺f̄|
};

/// A solve that iterates.
class IterativeSolve {
public:
  /// Keeps references; observer and balance may be null. Collective.
  IterativeSolve(const DualProblem& dual, const decomposition::ProblemData& data, const Vector* start,
                 qp::Observer* observer, const ErrorBalance* balance);

  /// \param resultants  ẽ; empty where no body floats
  DualSolution run(const Eigen::VectorXd& resultants);

private:
  [[nodiscard]] RCP<const qp::ConvexSet> feasibleForces() const;
  [[nodiscard]] qp::QuadraticProgram program() const;
  qp::QuadraticProgram shiftedProgram(const Eigen::VectorXd& resultants, const RCP<Vector>& shift);
  void setReference(Vector& rhs);
  void balance(const Eigen::VectorXd& resultants, double reference);
  void completeJumps(Vector& lambda) const;
  DualSolution finished();

  const DualProblem& dual_;
  const decomposition::DecomposedProblem& problem_;
  const decomposition::ProblemData& data_;
  const Vector* start_;
  qp::Observer* observer_;
  const ErrorBalance* balance_;
  RightHandSide wholeRhs_; ///< d̃
  DualSolution solution_;
  std::optional<BalancedTarget> target_; ///< with a balance
};

} // namespace epafi::fetidp
