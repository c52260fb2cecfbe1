#include "epafi/qp/RecessionDirection.hpp"

#include "epafi/base/Columns.hpp"
#include "epafi/qp/BoundProblem.hpp"

#include <Tpetra_Map.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace epafi::qp {
namespace {

constexpr double penalty = 1e12; ///< τ

/// I + τ(A/‖A‖ + BᵀB/‖B‖²).
class PenalizedIdentity final : public Operator {
public:
  PenalizedIdentity(RCP<const Operator> a, double operatorNorm, RCP<const EqualityConstraint> equality)
      : a_(std::move(a)), scale_(operatorNorm > 0 ? 1 / operatorNorm : 0.0), equality_(std::move(equality)),
        bx_(equality_.is_null() ? 0 : equality_->numEntries()), work_(a_->getDomainMap()) {}
  [[nodiscard]] RCP<const Map> getDomainMap() const override { return a_->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return a_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
             double beta) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      a_->apply(in, work_);
      work_.scale(penalty * scale_);
      if (!equality_.is_null()) {
        equality_->product(in, bx_);
        equality_->addTransposedProduct(bx_, penalty / (equality_->norm() * equality_->norm()), work_);
      }
      work_.update(1.0, in, 1.0);
      out.update(alpha, work_, beta);
    });
  }

private:
  RCP<const Operator> a_;
  double scale_;
  RCP<const EqualityConstraint> equality_;
  mutable std::vector<double> bx_;
  mutable Vector work_;
};

} // namespace

RecessionDirection findRecessionDirection(const RCP<const Operator>& a, double operatorNorm, const Vector& b,
                                          const ConvexSet& set, const RCP<const EqualityConstraint>& equality,
                                          int maxMultiplications) {
  RecessionDirection found;
  const double length = accurateNorm(b);
  if (length == 0)
    return found;
  const RCP<Vector> target = rcp(new Vector(b, Teuchos::Copy)), d = rcp(new Vector(b.getMap()));
  target->scale(1 / length);
  MprgpParameters parameters;
  parameters.maxMultiplications = maxMultiplications;
  const BoundProblem problem{rcp(new PenalizedIdentity(a, operatorNorm, equality)), target,
                             set.recessionCone(b.getMap()), Teuchos::null,
                             1 + penalty * (equality.is_null() ? 1 : 2)};
  const SolveReport report = solveBoundProblem(problem, *d, {1e-9, 1.0, 0.0}, parameters);
  found.multiplications = report.counts.hessianMultiplications + 1;

  const double norm = accurateNorm(*d);
  if (!(norm > 1e-6))
    return found;
  d->scale(1 / norm);
  Vector image(b.getMap());
  a->apply(*d, image);
  bool isCertificate = accurateDot(*d, *target) >= 1e-6 && accurateDot(*d, image) <= 1e-13 * operatorNorm;
  if (!equality.is_null()) {
    std::vector<double> bd(equality->numEntries());
    equality->product(*d, bd);
    isCertificate = isCertificate && std::sqrt(equality->dot(bd, bd)) <= 1e-6 * equality->norm();
  }
  if (isCertificate)
    found.direction = d;
  return found;
}

} // namespace epafi::qp
