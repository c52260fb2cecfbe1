#include "epafi/benchmarks/DenseProgram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace epafi::benchmarks {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

DenseProgram DenseProgram::unconstrained(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& linear) {
  const Eigen::Index n = linear.size();
  return {hessian,
          linear,
          Eigen::VectorXd::Constant(n, -infinity),
          Eigen::VectorXd::Constant(n, infinity),
          Eigen::MatrixXd(0, n),
          Eigen::VectorXd(0)};
}

Real DenseProgram::objective(const RealVector& x) const {
  const RealVector ax = hessian.cast<Real>() * x;
  return x.dot(ax) / 2 - linear.cast<Real>().dot(x);
}

RealVector DenseProgram::gradient(const RealVector& x, const RealVector& multiplier) const {
  RealVector g = hessian.cast<Real>() * x - linear.cast<Real>();
  if (numRows() > 0)
    g += rows.transpose().cast<Real>() * multiplier;
  return g;
}

double DenseProgram::roundOff(const Eigen::VectorXd& x, const Eigen::VectorXd& multiplier) const {
  const double epsilon = std::numeric_limits<double>::epsilon();
  double size = hessian.norm() * x.norm() + linear.norm();
  for (Eigen::Index i = 0; i < numRows(); ++i)
    size += rows.row(i).norm() * std::abs(multiplier[i]);
  return epsilon * std::sqrt(static_cast<double>(this->size())) * size;
}

double DenseResiduals::projectedGradient() const {
  return std::hypot(stationarity, dualFeasibility);
}

DenseResiduals residuals(const DenseProgram& program, const RealVector& x, const RealVector& multiplier) {
  const RealVector g = program.gradient(x, multiplier);
  Real free = 0, chopped = 0;
  DenseResiduals result;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Real lower = program.lower[i], upper = program.upper[i];
    result.feasibility =
        std::max({result.feasibility, static_cast<double>(lower - x[i]), static_cast<double>(x[i] - upper)});
    if (lower < x[i] && x[i] < upper)
      free += g[i] * g[i];
    else if (lower < upper && ((x[i] <= lower && g[i] < 0) || (x[i] >= upper && g[i] > 0)))
      chopped += g[i] * g[i];
  }
  result.stationarity = static_cast<double>(std::sqrt(free));
  result.dualFeasibility = static_cast<double>(std::sqrt(chopped));
  if (program.numRows() > 0) {
    const RealVector r = program.rows.cast<Real>() * x - program.values.cast<Real>();
    const double length = static_cast<double>(x.norm());
    result.equality = static_cast<double>(r.norm());
    for (Eigen::Index i = 0; i < r.size(); ++i)
      if (r[i] != 0)
        result.relativeEquality = std::max(
            result.relativeEquality, static_cast<double>(std::abs(r[i])) /
                                         (program.rows.row(i).norm() * length + std::abs(program.values[i])));
  }
  return result;
}

double separation(const DenseProgram& program, const Eigen::VectorXd& y, double tolerance) {
  const Eigen::VectorXd normal = program.rows.transpose() * y;
  const double size = (program.rows.rowwise().norm().array() * y.array().abs()).sum();
  double smallest = -program.values.dot(y);
  for (Eigen::Index i = 0; i < normal.size(); ++i) {
    const double best = normal[i] > 0 ? program.lower[i] : program.upper[i];
    if (std::isfinite(best))
      smallest += normal[i] * best;
    else if (std::abs(normal[i]) > tolerance * size)
      return -infinity;
  }
  return smallest;
}

std::string whyNotRecession(const DenseProgram& program, const Eigen::VectorXd& d, double tolerance) {
  std::ostringstream text;
  if (d.size() != program.size() || !d.allFinite() || std::abs(d.norm() - 1) > 1e-12)
    text << "no direction of length 1; ";
  else {
    if ((program.hessian * d).norm() > tolerance * program.hessian.norm())
      text << "‖Ad‖ = " << (program.hessian * d).norm() << "; ";
    if (program.numRows() > 0 && (program.rows * d).norm() > tolerance * program.rows.norm())
      text << "‖Bd‖ = " << (program.rows * d).norm() << "; ";
    if (!(program.linear.dot(d) > tolerance * program.linear.norm()))
      text << "bᵀd = " << program.linear.dot(d) << "; ";
    for (Eigen::Index i = 0; i < d.size(); ++i)
      if ((d[i] < -tolerance && std::isfinite(program.lower[i])) ||
          (d[i] > tolerance && std::isfinite(program.upper[i])))
        text << "entry " << i << " moves by " << d[i] << " towards a bound; ";
  }
  return text.str();
}

} // namespace epafi::benchmarks
