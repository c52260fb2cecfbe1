// The Newton steps of the independent solver.

#include "FrictionOracle.hpp"

#include <Eigen/LU>

#include <cmath>

namespace epafi::test {

VectorXd Condensed::equations(const VectorXd& rho, MatrixXd* derivative) const {
  const Index m = flexibility_.rows(), k = motions_.cols(), n = whole_.components;
  const VectorXd w = slip();
  VectorXd phi(m + k);
  phi.tail(k) = (motions_.transpose() * force_ - resultant_);
  if (derivative != nullptr) {
    derivative->setZero(m + k, m + k);
    derivative->bottomLeftCorner(k, m) = motions_.transpose();
  }
  const auto slipRow = [&](Index i) { // dw
    VectorXd row(m + k);
    row << -flexibility_.row(i).transpose(), motions_.row(i).transpose();
    return row;
  };
  for (std::size_t node = 0; node < whole_.laws.size(); ++node) {
    const Index i = static_cast<Index>(node) * n;
    const NodeLaw& law = whole_.laws[node];
    const double z = force_[i] + rho[i] * w[i];
    const bool isClosed = z > 0 && !isIdle(i);
    phi[i] = isClosed ? -rho[i] * w[i] : force_[i];
    VectorXd y = VectorXd::Zero(n - 1);
    for (Index t = 0; t < n - 1; ++t)
      if (!isIdle(i + 1 + t))
        y[t] = force_[i + 1 + t] + rho[i] * w[i + 1 + t];
    const double bound = law.at(isClosed ? z : 0), length = y.norm();
    const bool sticks = length <= bound && bound > 0;
    const VectorXd q = length > 0 ? VectorXd(y / length) : y;
    for (Index t = 0; t < n - 1; ++t) {
      const Index row = i + 1 + t;
      phi[row] = isIdle(row) ? force_[row] : sticks ? -rho[i] * w[row] : force_[row] - bound * q[t];
    }
    if (derivative == nullptr)
      continue;
    MatrixXd& d = *derivative;
    if (isClosed)
      d.row(i) = -rho[i] * slipRow(i);
    else
      d(i, i) = 1;
    for (Index t = 0; t < n - 1; ++t) {
      const Index row = i + 1 + t;
      if (isIdle(row)) {
        d(row, row) = 1;
        continue;
      }
      if (sticks) {
        d.row(row) = -rho[i] * slipRow(row);
        continue;
      }
      d(row, row) += 1;
      if (bound > 0 && isClosed) {
        d.row(row) -= q[t] * law.coefficient * rho[i] * slipRow(i);
        d(row, i) -= q[t] * law.coefficient;
      }
      for (Index s = 0; bound > 0 && s < n - 1; ++s) {
        const double across = bound / length * ((s == t ? 1.0 : 0.0) - q[s] * q[t]);
        if (isIdle(i + 1 + s) || across == 0)
          continue;
        d.row(row) -= across * rho[i] * slipRow(i + 1 + s);
        d(row, i + 1 + s) -= across;
      }
    }
  }
  return phi;
}

bool Condensed::newton(double factorOfStiffness) {
  const Index m = flexibility_.rows(), k = motions_.cols();
  const VectorXd rho = factorOfStiffness * stiffness_;
  MatrixXd derivative;
  int numSmall = 0;
  for (int step = 0; step < 40; ++step) {
    const VectorXd phi = equations(rho, &derivative);
    const double size = phi.norm();
    if (!std::isfinite(size))
      return false;
    if (residual(force_, slip()) < 1e-12 && phi.tail(k).norm() <= 1e-12 * (1e-30 + resultant_.norm()) &&
        ++numSmall > 1)
      return true;
    const VectorXd change = derivative.partialPivLu().solve(-phi);
    if (!change.allFinite())
      return false;
    const VectorXd force = force_, motion = motion_;
    double length = 1;
    for (int trial = 0; trial < 12; ++trial, length *= 0.5) {
      force_ = force + length * change.head(m);
      motion_ = motion + length * change.tail(k);
      if (equations(rho, nullptr).norm() < (1 - 1e-3 * length) * size || size < 1e-10 * scaleOf(force))
        break;
    }
    if (length < 1e-3) { // a whole step out of where it is stuck
      force_ = force + change.head(m);
      motion_ = motion + change.tail(k);
    }
  }
  return false;
}

} // namespace epafi::test
