#include "DualActiveSet.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

namespace epafi::test {
namespace {

constexpr Real unreached = std::numeric_limits<Real>::infinity();
/// A normal whose share outside the active ones is smaller than this depends on them.
constexpr Real dependent = 1e-11L;
constexpr Real violation = 1e-15L;
/// Bounds move outwards by this, relative to the largest, and by chance: no two constraints become active at
/// once, so that no cycle is possible.
constexpr Real perturbation = 1e-9L;

} // namespace

DualActiveSet::DualActiveSet(const DenseProgram& program, const RealMatrix& hessian, const RealVector& linear)
    : program_(program), hessian_(hessian), linear_(linear), lower_(program.lower.cast<Real>()),
      upper_(program.upper.cast<Real>()), rows_(program.rows.cast<Real>()),
      values_(program.values.cast<Real>()), rowScale_(RealVector::Ones(program.numRows())),
      isActive_(static_cast<std::size_t>(program.size()), false) {
  const Eigen::Index n = program.size();
  for (Eigen::Index i = 0; i < rows_.rows(); ++i)
    if (const Real length = rows_.row(i).norm(); length > 0) {
      rowScale_[i] = 1 / length;
      rows_.row(i) /= length;
      values_[i] /= length;
    }
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> share(1, 2);
  const Real length = largestBound(program);
  for (Eigen::Index i = 0; i < n; ++i)
    if (lower_[i] < upper_[i]) {
      lower_[i] -= perturbation * share(random) * length;
      upper_[i] += perturbation * share(random) * length;
    }
  const Eigen::LLT<RealMatrix> cholesky(hessian);
  if (cholesky.info() != Eigen::Success)
    throw std::invalid_argument("the dual active set method needs a Hessian that is positive definite");
  x_ = cholesky.solve(linear);
  j_ = cholesky.matrixU().solve(RealMatrix::Identity(n, n));
  r_ = RealMatrix::Zero(n, n);
}

bool DualActiveSet::run() {
  for (Eigen::Index i = 0; i < program_.size(); ++i)
    if (lower_[i] > upper_[i])
      return false;
  for (Eigen::Index i = 0; i < program_.size(); ++i)
    if (lower_[i] == upper_[i] && !enforce({Kind::fixed, i}))
      return false;
  for (Eigen::Index i = 0; i < program_.numRows(); ++i)
    if (!enforce({Kind::row, i}))
      return false;
  refine();
  Constraint next{};
  while (const Real worst = mostViolated(next)) {
    if (worst > -1e-4L * x_.norm()) {
      refine();
      if (mostViolated(next) == 0)
        return true;
    }
    if (!enforce(next))
      return false;
  }
  return true;
}

Real DualActiveSet::slack(Constraint constraint) const {
  const Eigen::Index i = constraint.index;
  switch (constraint.kind) {
  case Kind::row:
    return rows_.row(i).dot(x_) - values_[i];
  case Kind::upper:
    return upper_[i] - x_[i];
  default:
    return x_[i] - lower_[i];
  }
}

/// What round-off has left of the active constraints' slacks, and of the gradient along them, is taken away.
void DualActiveSet::refine() {
  const Eigen::Index q = active_.size();
  RealVector slacks(q);
  for (Eigen::Index k = 0; k < q; ++k)
    slacks[k] = slack(active_[k]);
  x_ -= j_.leftCols(q) * r_.topLeftCorner(q, q).triangularView<Eigen::Upper>().transpose().solve(slacks);
  const auto outside = j_.rightCols(x_.size() - q);
  x_ -= outside * (outside.transpose() * (hessian_ * x_ - linear_));
}

Real DualActiveSet::mostViolated(Constraint& constraint) const {
  Real worst = 0;
  for (Eigen::Index i = 0; i < program_.size(); ++i)
    if (!isActive_[i])
      for (const Kind kind : {Kind::lower, Kind::upper}) {
        const Real s = slack({kind, i});
        const Real bound = kind == Kind::lower ? lower_[i] : upper_[i];
        if (s < -violation * (1 + std::abs(bound)) && s < worst) {
          worst = s;
          constraint = {kind, i};
        }
      }
  return worst;
}

RealVector DualActiveSet::transformedNormal(Constraint constraint) const {
  const Eigen::Index i = constraint.index;
  if (constraint.kind == Kind::row)
    return j_.transpose() * rows_.row(i).transpose();
  return constraint.kind == Kind::upper ? RealVector(-j_.row(i)) : RealVector(j_.row(i));
}

/// Steps 2 of the paper: until the constraint holds, or is seen to contradict the active ones.
bool DualActiveSet::enforce(Constraint constraint) {
  Real multiplier = 0;
  const int limit = iterations_ + 100 + 50 * static_cast<int>(program_.size() + program_.numRows());
  while (true) {
    if (++iterations_ > limit)
      throw std::runtime_error("the dual active set method does not come to an end");
    const Eigen::Index q = active_.size();
    const Real s = slack(constraint);
    const RealVector d = transformedNormal(constraint);
    const RealVector r = r_.topLeftCorner(q, q).triangularView<Eigen::Upper>().solve(d.head(q));
    const Real outside = d.tail(d.size() - q).squaredNorm(); // zᵀn
    const bool depends = outside <= dependent * dependent * d.squaredNorm();
    if (depends && constraint.isEquality()) {
      if (!contradicts(constraint, r))
        return true; // redundant
      certify(constraint, r);
      return false;
    }
    Real longest = unreached; // t₁: until the first multiplier vanishes
    Eigen::Index first = -1;
    for (Eigen::Index k = 0; k < q && !constraint.isEquality(); ++k)
      if (!active_[k].isEquality() && r[k] > 0 && multipliers_[k] / r[k] < longest) {
        longest = multipliers_[k] / r[k];
        first = k;
      }
    const Real full = depends ? unreached : -s / outside; // t₂
    const bool isFull = constraint.isEquality() || full <= longest;
    const Real step = isFull ? full : longest;
    if (!std::isfinite(step)) {
      isActive_[constraint.index] = true; // not asked again
      if (!contradicts(constraint, r))
        return true; // it holds, but for round-off
      certify(constraint, r);
      return false;
    }
    for (Eigen::Index k = 0; k < q; ++k)
      multipliers_[k] -= step * r[k];
    multiplier += step;
    if (!depends)
      x_ += step * (j_.rightCols(d.size() - q) * d.tail(d.size() - q));
    if (isFull) {
      add(constraint, multiplier, d);
      return true;
    }
    drop(first);
  }
}

void DualActiveSet::add(Constraint constraint, Real multiplier, RealVector d) {
  const Eigen::Index q = active_.size();
  const Eigen::Index rest = d.size() - q;
  RealVector v = d.tail(rest); // Householder: d₂ becomes a multiple of e₁
  const Real length = v[0] > 0 ? -v.norm() : v.norm();
  v[0] -= length;
  if (const Real squared = v.squaredNorm(); squared > 0) {
    const RealVector image = j_.rightCols(rest) * v;
    j_.rightCols(rest) -= (2 / squared) * image * v.transpose();
    d[q] = length;
  }
  r_.col(q).head(q + 1) = d.head(q + 1);
  active_.push_back(constraint);
  multipliers_.push_back(multiplier);
  if (constraint.kind != Kind::row)
    isActive_[constraint.index] = true;
}

void DualActiveSet::drop(Eigen::Index position) {
  const Eigen::Index q = active_.size();
  isActive_[active_[position].index] = false;
  active_.erase(active_.begin() + position);
  multipliers_.erase(multipliers_.begin() + position);
  for (Eigen::Index k = position; k + 1 < q; ++k)
    r_.col(k) = r_.col(k + 1);
  r_.col(q - 1).setZero();
  for (Eigen::Index k = position; k + 1 < q; ++k) { // back to triangular
    Eigen::JacobiRotation<Real> rotation;
    rotation.makeGivens(r_(k, k), r_(k + 1, k));
    r_.block(0, k, q, q - k).applyOnTheLeft(k, k + 1, rotation.adjoint());
    r_(k + 1, k) = 0;
    j_.applyOnTheRight(k, k + 1, rotation);
  }
}

Real DualActiveSet::rightHandSide(Constraint constraint) const {
  const Eigen::Index i = constraint.index;
  if (constraint.kind == Kind::row)
    return values_[i];
  return constraint.kind == Kind::upper ? -upper_[i] : lower_[i];
}

/// Where n = Σ r_k n_k over the active constraints, Σ r_k s_k is what nᵀx must be.
bool DualActiveSet::contradicts(Constraint constraint, const RealVector& r) const {
  Real difference = rightHandSide(constraint), size = std::abs(difference);
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const Real share = r[k] * rightHandSide(active_[k]);
    difference -= share;
    size += std::abs(share);
  }
  return std::abs(difference) > 1e-11L * size;
}

/// n = Σ r_k n_k over the active constraints, so that the violation cannot be made good.
void DualActiveSet::certify(Constraint constraint, const RealVector& r) {
  RealVector y = RealVector::Zero(program_.numRows());
  if (constraint.kind == Kind::row)
    y[constraint.index] = 1;
  for (std::size_t k = 0; k < active_.size(); ++k)
    if (active_[k].kind == Kind::row)
      y[active_[k].index] -= r[k];
  y.array() *= rowScale_.array();
  certificate_ = (y / y.norm()).cast<double>();
  if (separation(program_, certificate_) < 0)
    certificate_ = -certificate_;
}

RealVector DualActiveSet::multiplier() const {
  RealVector mu = RealVector::Zero(program_.numRows());
  for (std::size_t k = 0; k < active_.size(); ++k)
    if (active_[k].kind == Kind::row)
      mu[active_[k].index] = -multipliers_[k] * rowScale_[active_[k].index];
  return mu;
}

Eigen::VectorXi DualActiveSet::held() const {
  Eigen::VectorXi result = Eigen::VectorXi::Zero(program_.size());
  for (const Constraint& constraint : active_)
    if (constraint.kind != Kind::row)
      result[constraint.index] = constraint.kind == Kind::upper ? 1 : -1;
  return result;
}

std::vector<Eigen::Index> DualActiveSet::activeRows() const {
  std::vector<Eigen::Index> result;
  for (const Constraint& constraint : active_)
    if (constraint.kind == Kind::row)
      result.push_back(constraint.index);
  return result;
}

} // namespace epafi::test
