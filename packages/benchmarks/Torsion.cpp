#include "epafi/benchmarks/Torsion.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>

namespace epafi::benchmarks {

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
  return {"torsion", grid, system.matrix, system.rightHandSide, lower, upper, {}};
}

} // namespace epafi::benchmarks
