#include "epafi/qp/solve/Feasibility.hpp"

#include "epafi/qp/constraints/PenalizedOperator.hpp"
#include "epafi/qp/solve/MprgpSolve.hpp"

#include <Tpetra_Map.hpp>

#include <vector>

namespace epafi::qp {
namespace {

/// Stops when Bx = c to round-off, or when BᵀW(Bx − c) has vanished beside Bx − c.
class LeastSquaresRule final : public StoppingRule {
public:
  LeastSquaresRule(const EqualityConstraint& equality, double smallest)
      : equality_(equality), smallest_(smallest), residual_(equality.numEntries()),
        weighed_(residual_.size()) {}
  [[nodiscard]] int numSums() const override { return equality_.numSums(); }
  void addLocalSums(const Vector& x, std::span<AccurateSum> sums) override {
    equality_.addLocalSums(x, sums);
  }
  bool isSatisfied(const GradientNorms& gradient, std::span<const AccurateSum> sums) override {
    norm_ = equality_.finishResidual(sums, residual_, weighed_);
    isStationary_ = gradient.euclidean <= 1e-9 * norm_ * equality_.norm();
    return norm_ <= smallest_ || isStationary_;
  }
  void describe(StepRecord& record) const override { record.constraintResidual = norm_; }

  [[nodiscard]] bool isStationary() const { return isStationary_; }
  [[nodiscard]] double residualNorm() const { return norm_; }
  [[nodiscard]] const std::vector<double>& weighed() const { return weighed_; } ///< W(Bx − c)

private:
  const EqualityConstraint& equality_;
  double smallest_;
  std::vector<double> residual_, weighed_;
  double norm_ = 0;
  bool isStationary_ = false;
};

} // namespace

Feasibility findFeasiblePoint(const RCP<const EqualityConstraint>& equality, const RCP<const ConvexSet>& set,
                              Vector& x) {
  const EqualityConstraint& b = *equality;
  Vector rhs(x.getMap()); // BᵀWc
  double rhsNorm = 0;
  if (!b.isHomogeneous()) {
    const auto c = b.rightHandSide();
    std::vector<double> weighed(c.size());
    b.weigh(c, weighed);
    b.addTransposedProduct(weighed, 1.0, rhs);
    rhsNorm = b.normOf(c);
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
    result.certificate = rule.weighed();
    for (double& value : result.certificate)
      value /= result.distance;
  }
  return result;
}

} // namespace epafi::qp
