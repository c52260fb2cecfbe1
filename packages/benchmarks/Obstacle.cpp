#include "epafi/benchmarks/Obstacle.hpp"

#include <Tpetra_Vector.hpp>

#include <cmath>

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
    return {"obstacle", grid, system.matrix, system.rightHandSide, lower, Teuchos::null, {}};
  }
  const auto s = [=](int i, int j) { return waves(i, j, 9.2, 9.3); };
  const RCP<const Vector> lower = grid.vector(map, [=](int i, int j) { return std::pow(s(i, j), 3); });
  const RCP<const Vector> upper = grid.vector(map, [=](int i, int j) { return std::pow(s(i, j), 2) + 0.02; });
  return {"two_obstacles", grid, system.matrix, system.rightHandSide, lower, upper, {}};
}

} // namespace epafi::benchmarks
