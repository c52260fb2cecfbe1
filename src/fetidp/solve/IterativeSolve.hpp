#pragma once

/// One solve of the dual problem that iterates.

#include "epafi/fetidp/solve/DualObservers.hpp"
#include "epafi/fetidp/solve/DualProblem.hpp"
#include "epafi/qp/ActiveSets.hpp"

#include <Teuchos_Time.hpp>

#include <functional>
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

  DualSolution coercive();
  /// \param resultants  ẽ
  DualSolution semicoercive(const Eigen::VectorXd& resultants);

private:
  bool setReference();
  void iterateInBounds();
  using Method = std::function<qp::SolveReport(Vector&, const qp::MprgpParameters&)>;
  /// The same within another set.
  using MethodWithin =
      std::function<qp::SolveReport(const RCP<const qp::ConvexSet>&, Vector&, const qp::MprgpParameters&)>;
  void iterate(const qp::ActiveSetProblem& faces, const qp::SmalbeTolerances& tolerances, Vector& x,
               qp::Observer* observer, const MethodWithin& within);
  void fixFriction(const qp::ActiveSetProblem& faces, const qp::SmalbeTolerances& tolerances, Vector& x,
                   const MethodWithin& within);
  [[nodiscard]] RCP<const qp::ConvexSet> feasibleForces() const;
  void goOn(const Method& method, Vector& x, int most);
  [[nodiscard]] bool isToGoOn() const;
  void refuseIfContradictory(const qp::ActiveSetProblem& faces, const Vector& x, int maxMultiplications);
  void completeJumps(Vector& lambda) const;
  DualSolution finished();

  const DualProblem& dual_;
  const decomposition::DecomposedProblem& problem_;
  const decomposition::ProblemData& data_;
  const Vector* start_;
  qp::Observer* observer_;
  const ErrorBalance* balance_;
  double tolerance_;
  RightHandSide wholeRhs_; ///< d̃
  RCP<Vector> rhs_;        ///< of the iteration: d̃, Pᵀd̃ where jumps are deflated, Pd where bodies float
  DualSolution solution_;
  std::optional<BalancedTarget> target_;     ///< with a balance
  double began_ = Teuchos::Time::wallTime(); ///< seconds
};

} // namespace epafi::fetidp
