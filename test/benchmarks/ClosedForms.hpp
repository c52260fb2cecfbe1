#pragma once

/// Obstacle problems whose solution is known, to measure errors with.

#include "epafi/benchmarks/BoundBenchmark.hpp"

#include <functional>

namespace epafi::test {

/// A benchmark with the solution of the continuous problem.
struct KnownBenchmark {
  benchmarks::BoundBenchmark problem;
  std::function<double(double x, double y)> exactSolution;

  /// Entry i is u_i − u(x_i, y_i). Not collective.
  [[nodiscard]] RCP<Vector> error(const Vector& u) const;
};

/// What u on the border brings to the right-hand side of −Δ at (i, j).
double fromBorder(const benchmarks::Grid& grid, int i, int j,
                  const std::function<double(double x, double y)>& u);

/// A string over a flat obstacle: −u'' = −f on (0, L), u = 0 at both ends, u ≥ −d; n unknowns, linear
/// elements. It touches if fL²/8 > d; with s = √(2d/f): u = fx²/2 − fsx on [0, s], −d on [s, L−s], mirrored
/// beyond; the contact force is f(L − 2s).
/// \throws InputError if n < 1. Collective.
KnownBenchmark stringOverObstacle(int n, const RCP<const Comm>& comm, double f = 10, double d = 0.5,
                                  double length = 1);

/// A round membrane over a flat obstacle: Δu = f in a disc, u = 0 at r = R, u ≥ −d. Solved for u(r) by linear
/// elements in r with the weight r of the area, which keeps second order (a square grid would see the round
/// border to first order only); n unknowns, r = 0 among them, so that grid.x is r. In contact for r ≤ b,
/// where f(b² − R²)/4 − (f b²/2) ln(b/R) + d = 0; u = f(r² − R²)/4 − (f b²/2) ln(r/R) outside. Precondition:
/// fR²/4 > d. \throws InputError if n < 1. Collective.
KnownBenchmark diskOverObstacle(int n, const RCP<const Comm>& comm, double f = 10, double d = 0.5,
                                double radius = 1);

/// The b of `diskOverObstacle`. Not collective.
double diskContactRadius(double f, double d, double radius);

/// A membrane over a ball: −Δu = 0 on (−2, 2)², u ≥ √(1 − r²) for r < 1 (no bound beyond), n × n unknowns,
/// linear elements on triangles. In contact for r ≤ a, where a² (ln 2 − ln a) = 1 − a²; u = −A ln r + B
/// outside, A = a²/√(1 − a²), B = A ln 2, on the border too. Bueler, *PETSc for Partial Differential
/// Equations* (SIAM 2021), ch. 12.
/// \throws InputError if n < 1. Collective.
KnownBenchmark ballObstacle(int n, const RCP<const Comm>& comm);

/// The a of `ballObstacle`. Not collective.
double ballContactRadius();

} // namespace epafi::test
