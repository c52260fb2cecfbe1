#include "epafi/qp/solve/RecessionDirection.hpp"

#include "epafi/base/Columns.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/qp/solve/MprgpSolve.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace epafi::qp {
namespace {

/// I + τ(A/‖A‖ + BᵀWB/‖B‖²).
class PenalizedIdentity final : public SymmetricOperator {
public:
  PenalizedIdentity(RCP<const Operator> a, double operatorNorm, RCP<const EqualityConstraint> equality)
      : SymmetricOperator(a->getDomainMap()), a_(std::move(a)),
        scale_(operatorNorm > 0 ? 1 / operatorNorm : 0.0), equality_(std::move(equality)),
        bx_(equality_.is_null() ? 0 : equality_->numEntries()), weighed_(bx_.size()) {}
  void setPenalty(double penalty) { penalty_ = penalty; }

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    a_->apply(x, y);
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      out.scale(penalty_ * scale_);
      if (!equality_.is_null()) {
        equality_->product(in, bx_);
        equality_->weigh(bx_, weighed_);
        equality_->addTransposedProduct(weighed_, penalty_ / (equality_->norm() * equality_->norm()), out);
      }
      out.update(1.0, in, 1.0);
    });
  }

  RCP<const Operator> a_;
  double scale_, penalty_ = 0; ///< 1/‖A‖, τ
  RCP<const EqualityConstraint> equality_;
  mutable std::vector<double> bx_, weighed_;
};

/// How far d, made of length 1, is from Ad = 0 and Bd = 0: the larger of ‖Ad‖/‖A‖ and ‖Bd‖/‖B‖; infinity
/// where d leads nowhere. One product.
double defect(const Operator& a, double operatorNorm, const Vector& target,
              const EqualityConstraint* equality, Vector& d) {
  const double norm = accurateNorm(d);
  if (!(norm > 1e-6))
    return std::numeric_limits<double>::infinity();
  d.scale(1 / norm);
  if (accurateDot(d, target) < 1e-6)
    return std::numeric_limits<double>::infinity();
  Vector image(d.getMap());
  a.apply(d, image);
  double largest = operatorNorm > 0 ? accurateNorm(image) / operatorNorm : 0.0;
  if (equality != nullptr) {
    std::vector<double> bd(equality->numEntries());
    equality->product(d, bd);
    largest = std::max(largest, equality->normOf(bd) / equality->norm());
  }
  return largest;
}

} // namespace

RecessionDirection findRecessionDirection(const RCP<const Operator>& a, double operatorNorm, const Vector& b,
                                          const ConvexSet& set, const RCP<const EqualityConstraint>& equality,
                                          int maxMultiplications) {
  RecessionDirection found;
  const double length = accurateNorm(b);
  if (length == 0)
    return found;
  const RCP<Vector> target = rcp(new Vector(b, Teuchos::Copy)), d = rcp(new Vector(b.getMap())),
                    previous = rcp(new Vector(b.getMap()));
  target->scale(1 / length);
  const RCP<PenalizedIdentity> hessian = rcp(new PenalizedIdentity(a, operatorNorm, equality));
  const RCP<const ConvexSet> cone = set.recessionCone(b.getMap());
  constexpr double wanted = 1e-10, believed = 1e-7;
  double smallest = std::numeric_limits<double>::infinity();
  MprgpParameters parameters;
  for (double penalty = 1e2; penalty < 1e13 && found.multiplications < maxMultiplications; penalty *= 10) {
    hessian->setPenalty(penalty); // each from the solution of the one before
    parameters.maxMultiplications = maxMultiplications - found.multiplications;
    const QuadraticProgram nearest{.hessian = hessian,
                                   .linearTerm = target,
                                   .set = cone,
                                   .operatorNorm = 1 + penalty * (equality.is_null() ? 1 : 2)};
    const SolveReport report = solveByMprgp(nearest, *d, {1e-9, 1.0}, parameters);
    found.multiplications += report.counts.hessianMultiplications + 1;
    const RCP<Vector> candidate =
        rcp(new Vector(*d, Teuchos::Copy)); // d(τ) = d(∞) + O(1/τ) within a face: extrapolated
    candidate->update(-1.0 / 9.0, *previous, 10.0 / 9.0);
    cone->project(*candidate);
    previous->assign(*d);
    const double candidateDefect = defect(*a, operatorNorm, *target, equality.get(), *candidate);
    if (candidateDefect < smallest) {
      smallest = candidateDefect;
      found.direction = candidate;
    }
    if (smallest <= wanted || !(accurateNorm(*d) > 1e-6)) // d shrinks with τ where there is no such direction
      break;
  }
  if (smallest > believed)
    found.direction = Teuchos::null;
  return found;
}

} // namespace epafi::qp
