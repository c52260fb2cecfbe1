#include "ClosedForms.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace epafi::test {

using namespace benchmarks;
namespace {

/// The zero of a function that changes its sign once in (low, high), to the last digits.
double zeroBetween(double low, double high, const std::function<double(double)>& function) {
  const bool isNegativeAtLow = function(low) < 0;
  for (int halvings = 0; halvings < 100; ++halvings) {
    const double middle = 0.5 * (low + high);
    ((function(middle) < 0) == isNegativeAtLow ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// n unknowns in (0, length).
Grid lineOf(int n, double length) {
  return {n, 1, 0, 0, length / (n + 1), 0};
}

} // namespace

double fromBorder(const Grid& grid, int i, int j, const std::function<double(double, double)>& u) {
  const Stencil s = laplaceStencil(grid, i, j);
  const auto at = [&](int column, int line, double weight) {
    const bool isInside = column >= 0 && column < grid.nx && line >= 0 && line < grid.ny;
    return isInside ? 0.0 : -weight * u(grid.x(column), grid.y(line));
  };
  return at(i, j - 1, s.south) + at(i - 1, j, s.west) + at(i + 1, j, s.east) + at(i, j + 1, s.north);
}

RCP<Vector> KnownBenchmark::error(const Vector& u) const {
  const Grid& grid = problem.grid;
  const RCP<Vector> result =
      grid.vector(u.getMap(), [&](int i, int j) { return exactSolution(grid.x(i), grid.y(j)); });
  result->update(1.0, u, -1.0);
  return result;
}

KnownBenchmark stringOverObstacle(int n, const RCP<const Comm>& comm, double f, double d, double length) {
  const Grid grid = lineOf(n, length);
  const double h = grid.hx;
  const auto stencil = [=](int, int) { return Stencil{2 / h, -1 / h, -1 / h}; };
  const FivePointSystem system = assembleFivePoint(grid, comm, stencil, [=](int, int) { return -f * h; });
  const RCP<const Vector> lower = grid.vector(system.rightHandSide->getMap(), [=](int, int) { return -d; });
  const auto exact = [=](double x, double /*y*/) {
    const double s = std::sqrt(2 * d / f), fromEnd = std::min(x, length - x);
    return fromEnd <= s ? f * fromEnd * fromEnd / 2 - f * s * fromEnd : -d;
  };
  return {{"string", grid, system.matrix, system.rightHandSide, lower, Teuchos::null}, exact};
}

double diskContactRadius(double f, double d, double radius) {
  return zeroBetween(1e-9 * radius, radius, [=](double b) {
    return f * (b * b - radius * radius) / 4 - f * b * b / 2 * std::log(b / radius) + d;
  });
}

KnownBenchmark diskOverObstacle(int n, const RCP<const Comm>& comm, double f, double d, double radius) {
  Grid grid = lineOf(n, radius);
  grid.hx = radius / n; // the first unknown stands at r = 0
  grid.left = -grid.hx;
  const double h = grid.hx;
  // ∫ r u'v' dr: an element's weight is its mean radius over h. ∫ r v dr: r h inside, h²/6 at r = 0.
  const auto stencil = [=](int i, int /*j*/) {
    const double inner = i > 0 ? (i - 0.5) : 0.0, outer = i + 0.5;
    return Stencil{inner + outer, -inner, -outer};
  };
  const auto load = [=](int i, int /*j*/) { return -f * (i > 0 ? i * h * h : h * h / 6); };
  const FivePointSystem system = assembleFivePoint(grid, comm, stencil, load);
  const RCP<const Vector> lower = grid.vector(system.rightHandSide->getMap(), [=](int, int) { return -d; });
  const double b = diskContactRadius(f, d, radius);
  const auto exact = [=](double r, double /*y*/) {
    return r <= b ? -d : f * (r * r - radius * radius) / 4 - f * b * b / 2 * std::log(r / radius);
  };
  return {{"disk", grid, system.matrix, system.rightHandSide, lower, Teuchos::null}, exact};
}

double ballContactRadius() {
  return zeroBetween(0.1, 0.9, [](double a) { return a * a * (std::log(2.0) - std::log(a)) - (1 - a * a); });
}

KnownBenchmark ballObstacle(int n, const RCP<const Comm>& comm) {
  const Grid grid = Grid::square(n, -2, 2, -2, 2);
  const double a = ballContactRadius(), slope = a * a / std::sqrt(1 - a * a);
  const auto exact = [=](double x, double y) {
    const double squared = x * x + y * y;
    return squared <= a * a ? std::sqrt(1 - squared) : slope * (std::log(2.0) - 0.5 * std::log(squared));
  };
  const auto stencil = [=](int i, int j) { return laplaceStencil(grid, i, j); };
  const auto load = [=](int i, int j) { return fromBorder(grid, i, j, exact); };
  const FivePointSystem system = assembleFivePoint(grid, comm, stencil, load);
  const auto ball = [=](int i, int j) {
    const double squared = grid.x(i) * grid.x(i) + grid.y(j) * grid.y(j);
    return squared < 1 ? std::sqrt(1 - squared) : -std::numeric_limits<double>::infinity();
  };
  const RCP<const Vector> lower = grid.vector(system.rightHandSide->getMap(), ball);
  return {{"ball", grid, system.matrix, system.rightHandSide, lower, Teuchos::null}, exact};
}

} // namespace epafi::test
