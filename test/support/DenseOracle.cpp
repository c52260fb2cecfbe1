#include "epafi/base/EigenCompatibility.hpp"

#include "DenseOracle.hpp"

#include "DualActiveSet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace epafi::test {
namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();

using Indices = std::vector<Eigen::Index>;

/// A, b as they are solved with, and the constraints with rows of length 1.
struct System {
  System(const DenseProgram& given, const RealMatrix& a, const RealVector& b)
      : program(given), hessian(a), linear(b), rows(given.rows.cast<Real>()),
        values(given.values.cast<Real>()), rowScale(RealVector::Ones(given.numRows())) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      if (const Real length = rows.row(i).norm(); length > 0) {
        rowScale[i] = 1 / length;
        rows.row(i) *= rowScale[i];
        values[i] *= rowScale[i];
      }
  }
  const DenseProgram& program;
  RealMatrix hessian;
  RealVector linear;
  RealMatrix rows;
  RealVector values, rowScale;

  [[nodiscard]] RealVector gradient(const RealVector& x, const RealVector& multiplier) const {
    RealVector g = hessian * x - linear;
    if (program.numRows() > 0)
      g += rows.transpose() * multiplier;
    return g;
  }
};

struct Point {
  RealVector x, multiplier; ///< that of the rows of length 1
};

void clip(const DenseProgram& program, RealVector& x) {
  x = x.cwiseMax(program.lower.cast<Real>()).cwiseMin(program.upper.cast<Real>());
}

/// The minimiser with the entries of `held` at their bounds and the rows of B as equations, the bounds of the
/// others left aside: Cholesky, least squares for μ, rounds of iterative refinement.
Point solveHeld(const System& system, const Eigen::VectorXi& held) {
  const DenseProgram& program = system.program;
  Indices free;
  Point point{RealVector(program.size()), RealVector::Zero(program.numRows())};
  for (Eigen::Index i = 0; i < program.size(); ++i) {
    point.x[i] = held[i] < 0 ? program.lower[i] : held[i] > 0 ? program.upper[i] : 0.0;
    if (held[i] == 0)
      free.push_back(i);
  }
  if (free.empty())
    return point;
  const RealMatrix a = system.hessian(free, free);
  const Eigen::LLT<RealMatrix> cholesky(a);
  const RealMatrix rows = system.rows(allOf, free);
  Eigen::ColPivHouseholderQR<RealMatrix> qr;
  if (program.numRows() > 0) {
    qr.setThreshold(1e-14L);
    qr.compute(cholesky.matrixL().solve(rows.transpose()));
  }
  for (int round = 0; round < 8; ++round) {
    const RealVector g = system.gradient(point.x, point.multiplier)(free);
    RealVector change = -cholesky.solve(g); // A δ + Bᵀν = −g, B δ = −r
    if (program.numRows() > 0) { // with A = LLᵀ, BL⁻ᵀ = (QR Pᵀ)ᵀ: RᵀR Pᵀν = Pᵀ(B δ₀ + r)
      const RealVector r = system.rows * point.x - system.values + rows * change;
      const Eigen::Index rank = qr.rank();
      const auto triangle = qr.matrixQR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>();
      const RealVector permuted = qr.colsPermutation().transpose() * r;
      RealVector nu = RealVector::Zero(program.numRows());
      nu.head(rank) = triangle.solve(triangle.transpose().solve(permuted.head(rank)));
      nu = qr.colsPermutation() * nu;
      point.multiplier += nu;
      change -= cholesky.solve(rows.transpose() * nu);
    }
    for (std::size_t k = 0; k < free.size(); ++k)
      point.x[free[k]] += change[k];
  }
  return point;
}

struct Quality {
  Real projectedGradient, equality;
};

Quality qualityOf(const System& system, const Point& point) {
  const DenseProgram& program = system.program;
  const RealVector g = system.gradient(point.x, point.multiplier);
  Quality quality{0, 0};
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const Real lower = program.lower[i], upper = program.upper[i];
    const bool isFree = lower < point.x[i] && point.x[i] < upper;
    if (isFree || (lower < upper && ((point.x[i] <= lower && g[i] < 0) || (point.x[i] >= upper && g[i] > 0))))
      quality.projectedGradient += g[i] * g[i];
  }
  quality.projectedGradient = std::sqrt(quality.projectedGradient);
  if (program.numRows() > 0)
    quality.equality = (system.rows * point.x - system.values).norm();
  return quality;
}

/// Entries outside their bounds become held, held ones whose multiplier has the wrong sign by more than
/// round-off free.
Eigen::VectorXi corrected(const System& system, const Point& point, Eigen::VectorXi held) {
  const DenseProgram& program = system.program;
  const RealVector g = system.gradient(point.x, point.multiplier);
  const Real roundOff = 1e-17L * (system.linear.norm() + system.hessian.norm() * point.x.norm());
  for (Eigen::Index i = 0; i < held.size(); ++i) {
    if (held[i] == 0 && point.x[i] < program.lower[i])
      held[i] = -1;
    else if (held[i] == 0 && point.x[i] > program.upper[i])
      held[i] = 1;
    else if (program.lower[i] < program.upper[i] && held[i] != 0 &&
             static_cast<Real>(held[i]) * g[i] > roundOff)
      held[i] = 0;
  }
  return held;
}

OracleAnswer solve(const System& system) {
  DualActiveSet method(system.program, system.hessian, system.linear);
  OracleAnswer answer;
  answer.isFeasible = method.run();
  answer.iterations = method.iterations();
  if (!answer.isFeasible) {
    answer.certificate = method.certificate();
    return answer;
  }
  const Real size = system.hessian.norm(); // makes gradients of lengths
  Point best{method.solution(), method.multiplier().cwiseQuotient(system.rowScale)};
  clip(system.program, best.x);
  Quality quality = qualityOf(system, best);
  Eigen::VectorXi held = method.held();
  for (int round = 0; round < 10; ++round) {
    Point point = solveHeld(system, held);
    const Eigen::VectorXi next = corrected(system, point, held);
    clip(system.program, point.x);
    const Quality found = qualityOf(system, point);
    if (found.projectedGradient + size * found.equality <
        quality.projectedGradient + size * quality.equality) {
      best = point;
      quality = found;
    }
    if (next == held)
      break;
    held = next;
  }
  answer.x = best.x;
  answer.multiplier = best.multiplier.cwiseProduct(system.rowScale);
  answer.residual = quality.projectedGradient;
  answer.objective = system.program.objective(answer.x);
  return answer;
}

} // namespace

OracleAnswer solveByDualActiveSet(const DenseProgram& program) {
  return solve(System(program, program.hessian.cast<Real>(), program.linear.cast<Real>()));
}

OracleAnswer solveByProximalSteps(const DenseProgram& program) {
  const System exact(program, program.hessian.cast<Real>(), program.linear.cast<Real>());
  const Real size = exact.hessian.norm();
  const Real length = std::max(static_cast<Real>(largestBound(program)), exact.values.norm());
  const Real delta = size > 0                                ? 1e-8L * size
                     : length > 0 && exact.linear.norm() > 0 ? exact.linear.norm() / length
                                                             : 1.0L;
  RealVector x = RealVector::Zero(program.size());
  OracleAnswer best;
  for (int step = 0; step < 100; ++step) {
    System proximal = exact;
    proximal.hessian.diagonal().array() += delta;
    proximal.linear += delta * x;
    OracleAnswer answer = solve(proximal);
    if (!answer.isFeasible)
      return answer;
    answer.residual = residuals(program, answer.x, answer.multiplier).projectedGradient();
    answer.iterations += best.iterations;
    const bool rests = step > 0 && answer.x == x;
    x = answer.x;
    if (step == 0 || answer.residual < best.residual)
      best = answer;
    if (rests || best.residual <= 1e-17L * (exact.linear.norm() + size * x.norm()))
      break;
  }
  return best;
}

OracleAnswer solveByEnumeration(const DenseProgram& program) {
  const Eigen::Index n = program.size(), m = program.numRows();
  const System system(program, program.hessian.cast<Real>(), program.linear.cast<Real>());
  const Real size = system.hessian.norm() > 0 ? system.hessian.norm() : 1.0L;
  OracleAnswer best;
  best.isFeasible = false;
  best.objective = infinity;
  Eigen::VectorXi held = Eigen::VectorXi::Constant(n, -1);
  const auto isAllowed = [&](Eigen::Index i) {
    if (held[i] == 0)
      return program.lower[i] < program.upper[i];
    return std::isfinite(held[i] < 0 ? program.lower[i] : program.upper[i]);
  };
  while (true) {
    bool allowed = true;
    for (Eigen::Index i = 0; i < n && allowed; ++i)
      allowed = isAllowed(i);
    if (allowed) { // [A Bᵀ; B 0] with held entries replaced by x_i = bound
      RealMatrix kkt = RealMatrix::Zero(n + m, n + m);
      RealVector rhs(n + m);
      kkt.topLeftCorner(n, n) = system.hessian / size;
      kkt.topRightCorner(n, m) = system.rows.transpose();
      kkt.bottomLeftCorner(m, n) = system.rows;
      rhs << system.linear / size, system.values;
      for (Eigen::Index i = 0; i < n; ++i)
        if (held[i] != 0) {
          kkt.row(i).setZero();
          kkt(i, i) = 1;
          rhs[i] = held[i] < 0 ? program.lower[i] : program.upper[i];
        }
      const RealVector solution = kkt.completeOrthogonalDecomposition().solve(rhs);
      RealVector x = solution.head(n);
      const Real slack = 1e-12L * x.norm();
      const bool solves = (kkt * solution - rhs).norm() <= 1e-12L * (rhs.norm() + solution.norm());
      const bool fits = (x.array() >= program.lower.cast<Real>().array() - slack).all() &&
                        (x.array() <= program.upper.cast<Real>().array() + slack).all();
      clip(program, x);
      if (const Real value = program.objective(x); solves && fits && value < best.objective) {
        best.isFeasible = true;
        best.objective = value;
        best.x = x;
      }
    }
    Eigen::Index i = 0; // the next choice
    while (i < n && held[i] == 1)
      held[i++] = -1;
    if (i == n)
      break;
    ++held[i];
  }
  return best;
}

} // namespace epafi::test
