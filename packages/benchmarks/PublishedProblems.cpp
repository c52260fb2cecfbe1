#include "epafi/benchmarks/PublishedProblems.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace epafi::benchmarks {

BoundBenchmark obstacle(int n, const RCP<const Comm>& comm, Obstacles obstacles, double borderWeight) {
  const Grid grid = Grid::square(n, 0, 1, 0, 1);
  const auto stencil = [=](int i, int j) { return laplaceStencil(grid, i, j, borderWeight); };
  const FivePointSystem system =
      assembleFivePoint(grid, comm, stencil, [=](int, int) { return grid.hx * grid.hy; });
  const RCP<const Map> map = system.rightHandSide->getMap();
  const auto waves = [=](int i, int j, double kx, double ky) {
    return std::sin(kx * grid.x(i)) * std::sin(ky * grid.y(j));
  };
  if (obstacles == Obstacles::below) {
    const RCP<const Vector> lower = grid.vector(map, [=](int i, int j) { return waves(i, j, 3.2, 3.3); });
    return {"obstacle", grid, system.matrix, system.rightHandSide, lower, Teuchos::null};
  }
  const auto s = [=](int i, int j) { return waves(i, j, 9.2, 9.3); };
  const RCP<const Vector> lower = grid.vector(map, [=](int i, int j) { return std::pow(s(i, j), 3); });
  const RCP<const Vector> upper = grid.vector(map, [=](int i, int j) { return std::pow(s(i, j), 2) + 0.02; });
  return {"two_obstacles", grid, system.matrix, system.rightHandSide, lower, upper};
}

BoundBenchmark torsion(int n, const RCP<const Comm>& comm, double c, double borderWeight) {
  const Grid grid = Grid::square(n, 0, 1, 0, 1);
  const auto stencil = [=](int i, int j) { return laplaceStencil(grid, i, j, borderWeight); };
  const FivePointSystem system =
      assembleFivePoint(grid, comm, stencil, [=](int, int) { return c * grid.hx * grid.hy; });
  const auto distance = [=](int i, int j) {
    return std::min({grid.x(i), 1 - grid.x(i), grid.y(j), 1 - grid.y(j)});
  };
  const RCP<const Map> map = system.rightHandSide->getMap();
  const RCP<const Vector> lower = grid.vector(map, [=](int i, int j) { return -distance(i, j); });
  const RCP<const Vector> upper = grid.vector(map, distance);
  return {"torsion", grid, system.matrix, system.rightHandSide, lower, upper};
}

BoundBenchmark journalBearing(int n, const RCP<const Comm>& comm, double eccentricity, double b) {
  const Grid grid = Grid::square(n, 0, 2 * std::numbers::pi, 0, 2 * b);
  const double hx = grid.hx, hy = grid.hy, area = hx * hy;
  const auto p = [=](double xi) { return std::pow(1 + eccentricity * std::cos(xi), 3); };
  const auto stencil = [=](int i, int /*j*/) {
    const double xi = grid.x(i);
    const double t1 = area * (2 * p(xi) + p(xi + hx)) / 6, t2 = area * (2 * p(xi) + p(xi - hx)) / 6;
    const double t3 = area * (p(xi) + 2 * p(xi + hx)) / 6, t4 = area * (p(xi) + 2 * p(xi - hx)) / 6;
    const double alongY = -(t1 + t2) / (hy * hy);
    const double centre = (t1 + t2 + t3 + t4) / (hx * hx) + 2 * (t1 + t2) / (hy * hy);
    return Stencil{centre, -(t2 + t4) / (hx * hx), -(t1 + t3) / (hx * hx), alongY, alongY};
  };
  const auto load = [=](int i, int /*j*/) { return eccentricity * area * std::sin(grid.x(i)); };
  const FivePointSystem system = assembleFivePoint(grid, comm, stencil, load);
  const RCP<const Vector> lower = rcp(new Vector(system.rightHandSide->getMap()));
  return {"journal_bearing", grid, system.matrix, system.rightHandSide, lower, Teuchos::null};
}

} // namespace epafi::benchmarks
