#include "FrictionOracle.hpp"

#include "epafi/base/EigenCompatibility.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <cmath>

namespace epafi::test {

Condensed::Condensed(const Whole& whole) : whole_(whole) {
  const Index m = whole.rows.rows(), numUnknowns = whole.stiffness.rows();
  flexibility_ = MatrixXd::Zero(m, m);
  offset_ = whole.rows * whole.prescribed - whole.gap;
  const VectorXd force = whole.load - whole.stiffness * whole.prescribed;
  std::vector<MatrixXd> kernels;
  std::vector<VectorXd> resultants;
  Index k = 0;
  for (int b = 0; b <= whole.body.back(); ++b) {
    Part& part = parts_.emplace_back();
    for (Index i = 0; i < numUnknowns; ++i)
      if (whole.body[static_cast<std::size_t>(i)] == b && !whole.isHeld[static_cast<std::size_t>(i)])
        part.unknowns.push_back(i);
    part.kernel = kernelOf(b, part.unknowns);
    MatrixXd stiffness = whole.stiffness(part.unknowns, part.unknowns);
    stiffness += stiffness.diagonal().mean() * part.kernel * part.kernel.transpose();
    part.factor.compute(stiffness);
    const MatrixXd own = whole.rows(allOf, part.unknowns);
    part.load = force(part.unknowns);
    flexibility_ += own * part.factor.solve(own.transpose());
    offset_ += own * part.factor.solve(part.load);
    kernels.emplace_back(own * part.kernel);
    resultants.emplace_back(part.kernel.transpose() * part.load);
    k += part.kernel.cols();
  }
  motions_.resize(m, k);
  resultant_.resize(k);
  Index column = 0;
  for (std::size_t b = 0; b < kernels.size(); ++b) {
    motions_.middleCols(column, kernels[b].cols()) = kernels[b];
    resultant_.segment(column, kernels[b].cols()) = resultants[b];
    column += kernels[b].cols();
  }
  flexibility_ = 0.5 * (flexibility_ + flexibility_.transpose()).eval();
  isIdle_.resize(static_cast<std::size_t>(m));
  for (Index i = 0; i < m; ++i)
    isIdle_[static_cast<std::size_t>(i)] = flexibility_(i, i) == 0;
  stiffness_.resize(m);
  for (Index i = 0; i < m; i += whole.components) {
    const double mean = flexibility_.diagonal().segment(i, whole.components).mean();
    stiffness_.segment(i, whole.components).setConstant(mean > 0 ? 1 / mean : 1);
  }
}

double Condensed::missing() const {
  if (resultant_.size() == 0 || resultant_.norm() == 0)
    return 0;
  // modes measured alike
  const VectorXd scale = motions_.colwise().norm().cwiseMax(1e-30);
  const MatrixXd g = (motions_ * scale.cwiseInverse().asDiagonal()).transpose();
  const VectorXd e = resultant_.cwiseQuotient(scale);
  const double step = 1 / (g * g.transpose()).operatorNorm();
  VectorXd x = VectorXd::Zero(g.cols()), y = x;
  double t = 1, least = e.norm();
  for (int round = 0; round < 30000; ++round) {
    const VectorXd gradient = g.transpose() * (g * y - e), before = x;
    x = ontoCones(y - step * gradient);
    if (gradient.dot(x - before) > 0)
      t = 1;
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * t * t));
    y = x + (t - 1) / next * (x - before);
    t = next;
    if (round % 100 == 99) {
      const double now = (g * x - e).norm();
      if (now < 1e-11 * e.norm() || (round > 5000 && now > (1 - 1e-4) * least))
        return now / e.norm();
      least = std::min(least, now);
    }
  }
  return (g * x - e).norm() / e.norm();
}

bool Condensed::solve() {
  const Index m = flexibility_.rows(), k = motions_.cols();
  force_ = VectorXd::Zero(m);
  motion_ = VectorXd::Zero(k);
  for (Index i = 0; i < m; i += whole_.components)
    if (isIdle(i) && offset_[i] > 1e-9 * offset_.lpNorm<Eigen::Infinity>())
      return false; // supports penetrate
  for (const double share : {0.3, 0.03, 3.0}) {
    MatrixXd system = MatrixXd::Zero(m + k, m + k);
    const VectorXd weight = share * stiffness_.cwiseInverse();
    system.topLeftCorner(m, m) = flexibility_ + MatrixXd(weight.asDiagonal());
    system.topRightCorner(m, k) = -motions_;
    system.bottomLeftCorner(k, m) = -motions_.transpose();
    const Eigen::PartialPivLU<MatrixXd> factor(system);
    VectorXd z = force_, y = VectorXd::Zero(m), rhs(m + k);
    for (const int rounds : {100, 400, 2000}) {
      for (int round = 0; round < rounds; ++round) {
        rhs << offset_ + weight.cwiseProduct(z - y), -resultant_;
        const VectorXd both = factor.solve(rhs);
        y += both.head(m);
        z = withinBounds(y);
        y -= z;
        motion_ = both.tail(k);
      }
      force_ = z;
      if (!z.allFinite())
        return false;
      const VectorXd force = force_, motion = motion_;
      for (const double factorOfStiffness : {1.0, 0.1, 10.0}) {
        force_ = force;
        motion_ = motion;
        if (newton(factorOfStiffness))
          return true;
      }
      force_ = force;
      motion_ = motion;
    }
  }
  return false;
}

VectorXd Condensed::displacement() const {
  VectorXd u = whole_.prescribed;
  Index column = 0;
  for (const Part& part : parts_) {
    const MatrixXd own = whole_.rows(allOf, part.unknowns);
    const VectorXd moved = part.factor.solve(part.load - own.transpose() * force_) +
                           part.kernel * motion_.segment(column, part.kernel.cols());
    u(part.unknowns) = moved;
    column += part.kernel.cols();
  }
  return u;
}

MatrixXd Condensed::kernelOf(int b, const std::vector<Index>& unknowns) const {
  const Index n = whole_.components, numModes = n == 2 ? 3 : 6;
  std::vector<Index> held;
  MatrixXd all = MatrixXd::Zero(whole_.stiffness.rows(), numModes);
  for (Index i = 0; i < all.rows(); ++i) {
    if (whole_.body[static_cast<std::size_t>(i)] != b)
      continue;
    const Index c = i % n;
    all(i, c) = 1;
    const auto at = [&](Index axis) { return whole_.places(i, axis); };
    if (n == 2)
      all(i, 2) = c == 0 ? -at(1) : at(0);
    else
      for (Index axis = 0; axis < 3; ++axis) // about it
        if (c != axis)
          all(i, 3 + axis) = c == (axis + 1) % 3 ? -at((axis + 2) % 3) : at((axis + 1) % 3);
    if (whole_.isHeld[static_cast<std::size_t>(i)])
      held.push_back(i);
  }
  MatrixXd free = MatrixXd::Identity(numModes, numModes);
  if (!held.empty()) {
    const MatrixXd rows = all(held, allOf);
    const Eigen::JacobiSVD<MatrixXd> svd(rows.transpose() * rows, Eigen::ComputeFullV);
    const Index rank = (svd.singularValues().array() > 1e-10 * svd.singularValues()[0]).count();
    free = svd.matrixV().rightCols(numModes - rank);
  }
  if (free.cols() == 0)
    return MatrixXd::Zero(static_cast<Index>(unknowns.size()), 0);
  const MatrixXd modes = all(unknowns, allOf) * free;
  return Eigen::HouseholderQR<MatrixXd>(modes).householderQ() *
         MatrixXd::Identity(modes.rows(), modes.cols());
}

VectorXd Condensed::withinBounds(VectorXd x) const {
  const Index n = whole_.components;
  for (std::size_t node = 0; node < whole_.laws.size(); ++node) {
    const Index i = static_cast<Index>(node) * n;
    for (Index k = i; k < i + n; ++k)
      x[k] = isIdle(k) ? 0 : x[k];
    x[i] = std::max(0.0, x[i]);
    auto tangential = x.segment(i + 1, n - 1);
    const double length = tangential.norm(), bound = whole_.laws[node].at(x[i]);
    if (length > bound)
      tangential *= bound / length;
  }
  return x;
}

VectorXd Condensed::ontoCones(VectorXd x) const {
  const Index n = whole_.components;
  for (std::size_t node = 0; node < whole_.laws.size(); ++node) {
    const Index i = static_cast<Index>(node) * n;
    const NodeLaw& law = whole_.laws[node];
    auto tangential = x.segment(i + 1, n - 1);
    const double length = tangential.norm();
    if (x[i] >= 0 && length <= law.at(x[i]))
      continue;
    const double along = std::max(0.0, (x[i] + (length - law.bound) * law.coefficient) /
                                           (1 + law.coefficient * law.coefficient));
    Eigen::Vector2d nearest(along, law.bound + along * law.coefficient);
    const Eigen::Vector2d here(x[i], length), onAxis(0, std::min(length, law.bound));
    if ((onAxis - here).norm() < (nearest - here).norm())
      nearest = onAxis;
    if (length > 0)
      tangential *= nearest[1] / length;
    x[i] = nearest[0];
  }
  return x;
}

} // namespace epafi::test
