#include "epafi/qp/solve/ScaledObjective.hpp"

#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/Timing.hpp"

#include <Teuchos_TimeMonitor.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::qp {

ScaledObjective::ScaledObjective(RCP<const Operator> a, double operatorNorm, int maxMultiplications,
                                 StepCounts& counts)
    : a_(std::move(a)), map_(a_->getDomainMap()),
      timer_(Teuchos::TimeMonitor::getNewCounter("Epafi::qp: product with the Hessian")),
      scale_(operatorNorm > 0 ? 1.0 / operatorNorm : 1.0), norm_(operatorNorm > 0 ? 1.0 : 0.0),
      maxMultiplications_(maxMultiplications), counts_(counts), b_(map_), reduction_(map_->getComm(), 4) {}

void ScaledObjective::setLinearTerm(const Vector& b, double constant) {
  b_.assign(b);
  linearNorm_ = scale_ * accurateNorm(b_);
  constant_ = scale_ * constant;
}

void ScaledObjective::shiftLinearTerm(const Vector& shift, double objectiveShift, const Vector& x) {
  b_.update(-1.0, shift, 1.0);
  linearNorm_ = scale_ * accurateNorm(b_);
  constant_ += scale_ * (objectiveShift - accurateDot(shift, x));
}

void ScaledObjective::multiply(const Vector& x, Vector& y) {
  const Timing timing(*timer_);
  a_->apply(x, y);
  ++counts_.hessianMultiplications;
}

void ScaledObjective::gradient(const Vector& y, Vector& g) const {
  const auto image = localData(y), b = localData(b_);
  const auto result = localDataNonConst(g);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = scale_ * (image[i] - b[i]);
}

StepSizes ScaledObjective::stepSizes(const Vector& g, const Vector& p, const Vector& ap, double feasible) {
  const auto gradient = localData(g), direction = localData(p), image = localData(ap);
  AccurateSum curvature, slope, squared;
  for (std::size_t i = 0; i < direction.size(); ++i) {
    curvature.add(direction[i] * image[i]);
    slope.add(gradient[i] * direction[i]);
    squared.add(direction[i] * direction[i]);
  }
  reduction_.clear();
  reduction_.sums()[0] = curvature;
  reduction_.sums()[1] = slope;
  reduction_.sums()[2] = squared;
  reduction_.setMinimum(feasible);
  reduction_.reduce();
  const StepSizes sizes{scale_ * reduction_.sum(0), reduction_.sum(1), reduction_.sum(2),
                        reduction_.minimum()};
  if (sizes.squared > 0 && sizes.curvature > norm_ * sizes.squared)
    correctNorm(sizes.curvature / sizes.squared);
  return sizes;
}

Trial ScaledObjective::evaluate(const Vector& y, const Vector& ay, const Vector& x, const Vector& p) {
  const auto trial = localData(y), image = localData(ay), from = localData(x), direction = localData(p),
             b = localData(b_);
  AccurateSum quadratic, linear, squared, slope;
  for (std::size_t i = 0; i < trial.size(); ++i) {
    const double d = trial[i] - from[i];
    quadratic.add(trial[i] * image[i]);
    linear.add(trial[i] * b[i]);
    squared.add(d * d);
    slope.add(d * direction[i]);
  }
  reduction_.clear();
  const auto sums = reduction_.sums();
  sums[0] = quadratic;
  sums[1] = linear;
  sums[2] = squared;
  sums[3] = slope;
  reduction_.reduce();
  const double yay = scale_ * reduction_.sum(0), yb = scale_ * reduction_.sum(1);
  return {0.5 * yay - yb + constant_, std::abs(yay) + std::abs(yb), reduction_.sum(2), reduction_.sum(3)};
}

void ScaledObjective::correctNorm(double rayleighQuotient) {
  constexpr double margin = 1.05; // quotients approach the norm from below
  norm_ = margin * rayleighQuotient;
  ++counts_.normCorrections;
}

void ScaledObjective::raiseNorm(double operatorNorm) {
  norm_ = std::max(norm_, scale_ * operatorNorm);
}

} // namespace epafi::qp
