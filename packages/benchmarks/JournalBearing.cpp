#include "epafi/benchmarks/JournalBearing.hpp"

#include <Tpetra_Vector.hpp>

#include <cmath>
#include <numbers>

namespace epafi::benchmarks {

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
  return {"journal_bearing", grid, system.matrix, system.rightHandSide, lower, Teuchos::null, {}};
}

} // namespace epafi::benchmarks
