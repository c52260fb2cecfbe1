#include "epafi/qp/Feasibility.hpp"

#include "epafi/qp/BoundProblem.hpp"
#include "epafi/qp/PenalizedOperator.hpp"

#include <Tpetra_Map.hpp>

#include <cmath>

namespace epafi::qp {
namespace {

/// Stops when Bx = c to round-off, or when Bᵀ(Bx − c) has vanished beside Bx − c.
class LeastSquaresRule final : public StoppingRule {
public:
  LeastSquaresRule(const EqualityConstraint& equality, double smallest)
      : equality_(equality), smallest_(smallest), residual_(equality.numEntries()) {}
  [[nodiscard]] int numSums() const override { return equality_.numSums(); }
  void addLocalSums(const Vector& x, std::span<AccurateSum> sums) override {
    equality_.addLocalSums(x, sums);
  }
  bool isSatisfied(const GradientNorms& gradient, std::span<const AccurateSum> sums) override {
    norm_ = equality_.finishResidual(sums, residual_);
    isStationary_ = gradient.euclidean <= 1e-9 * norm_ * equality_.norm();
    return norm_ <= smallest_ || isStationary_;
  }
  void describe(StepRecord& record) const override { record.constraintResidual = norm_; }

  [[nodiscard]] bool isStationary() const { return isStationary_; }
  [[nodiscard]] double residualNorm() const { return norm_; }
  [[nodiscard]] const std::vector<double>& residual() const { return residual_; }

private:
  const EqualityConstraint& equality_;
  double smallest_;
  std::vector<double> residual_;
  double norm_ = 0;
  bool isStationary_ = false;
};

} // namespace

Feasibility findFeasiblePoint(const RCP<const EqualityConstraint>& equality, const RCP<const ConvexSet>& set,
                              Vector& x) {
  const EqualityConstraint& b = *equality;
  Vector rhs(x.getMap()); // Bᵀc
  double rhsNorm = 0;
  if (!b.isHomogeneous()) {
    b.addTransposedProduct(b.rightHandSide(), 1.0, rhs);
    rhsNorm = std::sqrt(b.dot(b.rightHandSide(), b.rightHandSide()));
  }
  set->project(x);
  MprgpParameters parameters;
  parameters.maxMultiplications = 2000;
  Mprgp solver(rcp(new PenalizedOperator(Teuchos::null, x.getMap(), equality, 1.0)), set, parameters,
               b.norm() * b.norm());
  solver.start(rhs, x);
  LeastSquaresRule rule(b, 1e-13 * (rhsNorm + b.norm() * accurateNorm(x)));
  runToCertificate(solver, rule, nullptr);
  x.assign(solver.solution());

  Feasibility result;
  result.distance = rule.residualNorm();
  result.isFeasible =
      !(rule.isStationary() && result.distance > 1e-8 * (rhsNorm + b.norm() * accurateNorm(x)));
  if (!result.isFeasible) {
    result.certificate = rule.residual();
    for (double& value : result.certificate)
      value /= result.distance;
  }
  return result;
}

} // namespace epafi::qp
