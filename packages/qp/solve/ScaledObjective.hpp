#pragma once

/// f(x) = ½xᵀAx − bᵀx + constant as MPRGP works with it: divided by ‖A‖, as estimated at the start, so that
/// gradients have the units of x and no threshold has any. The gradient is g = (Ax − b)/‖A‖.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/qp/solve/SolveReport.hpp"

#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

namespace Teuchos {
class Time;
} // namespace Teuchos

namespace epafi::qp {

/// What one product with p tells.
struct StepSizes {
  double curvature = 0; ///< pᵀAp
  double slope = 0;     ///< gᵀp
  double squared = 0;   ///< pᵀp
  double feasible = 0;  ///< α_f: largest α with x − αp feasible
};

/// What one product with a trial point y tells, which a step along p from x led to.
struct Trial {
  double objective = 0;
  double size = 0;    ///< |yᵀAy| + |yᵀb|, against which round-off counts
  double squared = 0; ///< dᵀd of d = y − x
  double slope = 0;   ///< dᵀp
};

/// All that it takes and returns is scaled, unless said otherwise. Counts the products.
class ScaledObjective {
public:
  /// \param a                   kept
  /// \param operatorNorm        over-estimate of ‖A‖, > 0 unless A = 0, not scaled
  /// \param maxMultiplications  products at most
  /// \param counts              where products and corrections of ‖A‖ are counted; kept
  ScaledObjective(RCP<const Operator> a, double operatorNorm, int maxMultiplications, StepCounts& counts);

  /// b and the constant, not scaled. Collective.
  void setLinearTerm(const Vector& b, double constant);
  /// b −= shift; the objective at x grows by objectiveShift. Neither is scaled. Collective.
  void shiftLinearTerm(const Vector& shift, double objectiveShift, const Vector& x);

  /// y = Ax, not scaled; one product.
  void multiply(const Vector& x, Vector& y);
  /// g = (y − b)/‖A‖ from y = Ax.
  void gradient(const Vector& y, Vector& g) const;
  /// From Ap; one message. A Rayleigh quotient above ‖A‖ corrects that. Streams p, Ap, g.
  StepSizes stepSizes(const Vector& g, const Vector& p, const Vector& ap, double feasible);
  /// At y, with Ay; one message.
  Trial evaluate(const Vector& y, const Vector& ay, const Vector& x, const Vector& p);

  [[nodiscard]] const RCP<const Map>& map() const { return map_; } ///< of x
  [[nodiscard]] const Operator& hessian() const { return *a_; }    ///< A
  [[nodiscard]] double scale() const { return scale_; }            ///< 1/‖A‖ as it was given
  [[nodiscard]] double norm() const { return norm_; } ///< ‖A‖: 1 until it is corrected, 0 for A = 0
  [[nodiscard]] double linearNorm() const { return linearNorm_; } ///< ‖b‖
  [[nodiscard]] double constant() const { return constant_; }     ///< f(0)
  [[nodiscard]] const Vector& linearTerm() const { return b_; }   ///< b, not scaled
  /// Whether the products are spent.
  [[nodiscard]] bool isSpent() const { return counts_.hessianMultiplications >= maxMultiplications_; }
  /// A curvature pᵀAp no larger than this is zero, as far as products in double precision can tell. \param
  /// squared pᵀp
  [[nodiscard]] double zeroCurvature(double squared) const { return 1e-14 * norm_ * squared; }
  /// A Rayleigh quotient as large as that was seen.
  void correctNorm(double rayleighQuotient);
  /// ‖A‖ is no smaller than this, not scaled.
  void raiseNorm(double operatorNorm);

private:
  RCP<const Operator> a_;
  RCP<const Map> map_;
  RCP<Teuchos::Time> timer_;
  double scale_, norm_;
  int maxMultiplications_;
  StepCounts& counts_;
  Vector b_;
  double linearNorm_ = 0, constant_ = 0;
  FusedReduction reduction_;
};

} // namespace epafi::qp
