#include "epafi/qp/Mprgp.hpp"

#include "epafi/base/Parameters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::qp {

Teuchos::ParameterList MprgpParameters::validParameters() {
  const MprgpParameters defaults;
  Teuchos::ParameterList list("MPRGP");
  addReal(list, "Proportioning Constant", defaults.proportioningConstant,
          "Γ: the iterate is called proportional, and stays in its face, while the chopped gradient is no "
          "longer than Γ "
          "times the free one.",
          0.0, 1e6, true);
  addReal(list, "Expansion Step", defaults.expansionStep,
          "Fixed step length of expansions as a multiple of 1/‖A‖; convergence is proved below 2.", 0.0, 2.0,
          true, true);
  addInteger(list, "Maximum Multiplications", defaults.maxMultiplications,
             "Products with the operator at most, over all outer iterations together; limits CG too.", 1);
  return list;
}

MprgpParameters MprgpParameters::from(const Teuchos::ParameterList& list) {
  MprgpParameters parameters;
  parameters.proportioningConstant = list.get<double>("Proportioning Constant");
  parameters.expansionStep = list.get<double>("Expansion Step");
  parameters.maxMultiplications = list.get<int>("Maximum Multiplications");
  return parameters;
}

Mprgp::Mprgp(RCP<const Operator> a, Bounds bounds, const MprgpParameters& parameters, double operatorNorm)
    : a_(std::move(a)), bounds_(std::move(bounds)), parameters_(parameters),
      stepLength_(operatorNorm > 0 ? parameters.expansionStep / operatorNorm : 1.0),
      comm_(a_->getDomainMap()->getComm()), x_(a_->getDomainMap()), b_(a_->getDomainMap()),
      g_(a_->getDomainMap()), p_(a_->getDomainMap()), ap_(a_->getDomainMap()), stepReduction_(comm_, 2),
      measureReduction_(comm_, 5) {}

void Mprgp::start(const Vector& b, const Vector& x0) {
  b_.assign(b);
  x_.assign(x0);
  bounds_.project(x_);
  if (x_.normInf() == 0) { // g = −b needs no product
    g_.update(-1.0, b_, 0.0);
    objective_ = 0;
    gradientIsFresh_ = true;
  } else {
    refreshGradient();
  }
}

void Mprgp::moveTo(const Vector& x) {
  x_.assign(x);
  bounds_.project(x_);
  refreshGradient();
}

void Mprgp::refreshGradient() {
  applyHessian(x_, g_);
  g_.update(-1.0, b_, 1.0);
  objective_ = 0.5 * (accurateDot(x_, g_) - accurateDot(x_, b_));
  gradientIsFresh_ = true;
}

void Mprgp::shiftLinearTerm(const Vector& shift, double objectiveShift) {
  b_.update(-1.0, shift, 1.0);
  g_.update(1.0, shift, 1.0);
  objective_ += objectiveShift;
}

// The loop of the paper.
Status Mprgp::run(StoppingRule& rule, Observer* observer) {
  measureReduction_ = FusedReduction(comm_, 5 + rule.numSums());
  ap_.putScalar(0.0);
  measure(rule);
  setDirectionToFreeGradient(0.0); // p = φ
  record(rule, StepKind::start, observer);

  while (!rule.isSatisfied(projectedGradient_, measureReduction_.sums().subspan(5))) {
    if (!std::isfinite(projectedGradient_))
      return Status::notFinite;
    if (counts_.hessianMultiplications >= parameters_.maxMultiplications)
      return Status::maxIterations;

    if (!isProportional()) {
      if (const Status status = proportioningStep(rule); status != Status::converged)
        return status;
      record(rule, StepKind::proportioning, observer);
      continue;
    }
    applyHessian(p_, ap_);
    const StepSizes sizes = stepSizes();
    if (!(sizes.curvature > 0))
      return std::isfinite(sizes.curvature) ? Status::indefiniteOperator : Status::notFinite;
    if (sizes.slope <= sizes.feasible * sizes.curvature) { // α_cg = gᵀp / pᵀAp ≤ α_f
      conjugateGradientStep(sizes, rule);
      record(rule, StepKind::conjugateGradient, observer);
    } else {
      const bool isDone = expansionStep(sizes, rule);
      record(rule, StepKind::expansion, observer);
      if (!isDone)
        return Status::stagnated;
    }
  }
  return Status::converged;
}

bool Mprgp::isProportional() const {
  const double gamma = parameters_.proportioningConstant;
  return choppedSquared_ <= gamma * gamma * reducedTimesFree_; // βᵀβ ≤ Γ² φ̃ᵀφ
}

void Mprgp::conjugateGradientStep(const StepSizes& sizes, StoppingRule& rule) {
  ++counts_.conjugateGradient;
  move(sizes.slope / sizes.curvature, sizes);                    // x −= α_cg p, g −= α_cg Ap
  measure(rule);                                                 // φ, β and φᵀAp
  setDirectionToFreeGradient(freeTimesImage_ / sizes.curvature); // p = φ − (φᵀAp / pᵀAp) p
}

/// Returns false if no step, however short, keeps the objective from growing.
bool Mprgp::expansionStep(const StepSizes& sizes, StoppingRule& rule) {
  ++counts_.expansion;
  move(sizes.feasible, sizes); // x^½ = x − α_f p
  storeHalfStep();
  const double halfObjective = objective_;
  bool isDone = false;
  for (int halvings = 0; !isDone && halvings < 60; ++halvings) {
    const double size = projectHalfStep(); // x = P(x^½ − ᾱφ(x^½)),  g = Ax − b
    // By the bound on ᾱ the objective cannot grow; if it does beyond round-off, ‖A‖ was underestimated.
    const double roundOff = 1e-12 * (std::abs(halfObjective) + size);
    isDone = objective_ <= halfObjective + roundOff || !std::isfinite(objective_) ||
             counts_.hessianMultiplications >= parameters_.maxMultiplications;
    if (!isDone)
      stepLength_ *= 0.5;
  }
  ap_.putScalar(0.0);
  measure(rule);
  setDirectionToFreeGradient(0.0); // p = φ
  return isDone;
}

/// Returns converged if the step could be made.
Status Mprgp::proportioningStep(StoppingRule& rule) {
  ++counts_.proportioning;
  setDirectionToChoppedGradient(); // p = β
  applyHessian(p_, ap_);
  const StepSizes sizes = stepSizes();
  if (!std::isfinite(sizes.curvature))
    return Status::notFinite;
  if (sizes.curvature <= 0 && !std::isfinite(sizes.feasible))
    return Status::indefiniteOperator;
  const double exact = sizes.curvature > 0 ? sizes.slope / sizes.curvature : sizes.feasible;
  move(std::min(exact, sizes.feasible), sizes);
  measure(rule);
  setDirectionToFreeGradient(0.0); // p = φ
  return Status::converged;
}

void Mprgp::applyHessian(const Vector& x, Vector& ax) {
  a_->apply(x, ax);
  ++counts_.hessianMultiplications;
}

/// pᵀAp, gᵀp and α_f in one pass and one message. Streams p, Ap, g, x, l, u.
Mprgp::StepSizes Mprgp::stepSizes() {
  const auto x = localData(x_), g = localData(g_), p = localData(p_), ap = localData(ap_);
  const Bounds::Local bounds = bounds_.local();
  stepReduction_.clear();
  AccurateSum curvature, slope;
  double feasible = stepReduction_.minimum();
  for (std::size_t i = 0; i < p.size(); ++i) {
    curvature.add(p[i] * ap[i]);
    slope.add(g[i] * p[i]);
    feasible = std::min(feasible, bounds[i].maxFeasibleStep(x[i], p[i]));
  }
  stepReduction_.sums()[0] = curvature;
  stepReduction_.sums()[1] = slope;
  stepReduction_.setMinimum(feasible);
  stepReduction_.reduce();
  return {stepReduction_.sum(0), stepReduction_.sum(1), stepReduction_.minimum()};
}

/// x −= αp, g −= αAp, f follows: f(x − αp) = f − α gᵀp + ½α² pᵀAp.
void Mprgp::move(double step, const StepSizes& sizes) {
  const auto x = localDataNonConst(x_), g = localDataNonConst(g_);
  const auto p = localData(p_), ap = localData(ap_);
  const Bounds::Local bounds = bounds_.local();
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = bounds[i].project(x[i] - step * p[i]); // feasible already but for the last digit
    g[i] -= step * ap[i];
  }
  objective_ += step * (0.5 * step * sizes.curvature - sizes.slope);
  gradientIsFresh_ = false;
}

/// An expansion needs p and Ap no more: they keep x^½ and φ(x^½), should the step have to be repeated.
void Mprgp::storeHalfStep() {
  const auto x = localData(x_), g = localData(g_);
  const auto half = localDataNonConst(p_), free = localDataNonConst(ap_);
  const Bounds::Local bounds = bounds_.local();
  for (std::size_t i = 0; i < x.size(); ++i) {
    half[i] = x[i];
    free[i] = bounds[i].freeGradient(x[i], g[i]);
  }
}

/// x = P(x^½ − ᾱφ), g = Ax − b, f = ½xᵀ(g − b). Returns |xᵀb| + |xᵀAx|, the size against which round-off
/// counts.
double Mprgp::projectHalfStep() {
  const auto x = localDataNonConst(x_);
  const auto half = localData(p_), free = localData(ap_);
  const Bounds::Local bounds = bounds_.local();
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = bounds[i].project(half[i] - stepLength_ * free[i]);
  applyHessian(x_, g_);

  stepReduction_.clear();
  const auto g = localDataNonConst(g_);
  const auto b = localData(b_);
  const auto sums = stepReduction_.sums();
  for (std::size_t i = 0; i < x.size(); ++i) {
    sums[0].add(x[i] * g[i]);
    sums[1].add(x[i] * b[i]);
    g[i] -= b[i];
  }
  stepReduction_.reduce();
  const double quadratic = stepReduction_.sum(0), linear = stepReduction_.sum(1);
  objective_ = 0.5 * quadratic - linear;
  gradientIsFresh_ = true;
  return std::abs(quadratic) + std::abs(linear);
}

/// All that the loop asks of the split gradient, in one pass and one message. Streams x, g, Ap, l, u.
void Mprgp::measure(StoppingRule& rule) {
  const auto x = localData(x_), g = localData(g_), ap = localData(ap_);
  const Bounds::Local bounds = bounds_.local();
  measureReduction_.clear();
  const std::span<AccurateSum> sums = measureReduction_.sums();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Bounds::Interval interval = bounds[i];
    if (interval.isFree(x[i])) {
      const double free = g[i];
      sums[0].add(free * free);
      sums[2].add(free * interval.reducedFreeGradient(x[i], free, stepLength_));
      sums[3].add(free * ap[i]);
    } else {
      const double chopped = interval.choppedGradient(x[i], g[i]);
      sums[1].add(chopped * chopped);
      sums[4].add(1);
    }
  }
  rule.addLocalSums(x_, sums.subspan(5));
  measureReduction_.reduce();
  freeSquared_ = sums[0].value();
  choppedSquared_ = sums[1].value();
  reducedTimesFree_ = sums[2].value();
  freeTimesImage_ = sums[3].value();
  activeBounds_ = static_cast<long long>(sums[4].value());
  projectedGradient_ = std::sqrt(freeSquared_ + choppedSquared_);
}

/// p = φ − conjugation · p. Streams x, g, p, l, u.
void Mprgp::setDirectionToFreeGradient(double conjugation) {
  const auto x = localData(x_), g = localData(g_);
  const auto p = localDataNonConst(p_);
  const Bounds::Local bounds = bounds_.local();
  for (std::size_t i = 0; i < p.size(); ++i)
    p[i] = bounds[i].freeGradient(x[i], g[i]) - (conjugation != 0 ? conjugation * p[i] : 0.0);
}

/// p = β.
void Mprgp::setDirectionToChoppedGradient() {
  const auto x = localData(x_), g = localData(g_);
  const auto p = localDataNonConst(p_);
  const Bounds::Local bounds = bounds_.local();
  for (std::size_t i = 0; i < p.size(); ++i)
    p[i] = bounds[i].choppedGradient(x[i], g[i]);
}

void Mprgp::record(const StoppingRule& rule, StepKind kind, Observer* observer) {
  if (observer == nullptr)
    return;
  StepRecord step;
  step.iteration = counts_.conjugateGradient + counts_.expansion + counts_.proportioning;
  step.outer = counts_.outer;
  step.kind = kind;
  step.projectedGradient = projectedGradient_;
  step.objective = objective_;
  step.activeBounds = activeBounds_;
  step.hessianMultiplications = counts_.hessianMultiplications;
  rule.describe(step);
  observer->step(step);
}

} // namespace epafi::qp
