#include "Obstacle.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

using namespace epafi;

Obstacle makeObstacle(GlobalOrdinal n, const RCP<const Comm>& comm) {
  const double h = 1.0 / static_cast<double>(n + 1);
  const RCP<const Map> map = rcp(new Map(static_cast<std::size_t>(n * n), 0, comm));
  const RCP<CrsMatrix> a = rcp(new CrsMatrix(map, 5));
  for (GlobalOrdinal row = map->getMinGlobalIndex(); row <= map->getMaxGlobalIndex(); ++row) {
    const auto couple = [&](GlobalOrdinal to, double value) { a->insertGlobalValues(row, 1, &value, &to); };
    couple(row, 4.0);
    if (row % n > 0)
      couple(row - 1, -1.0);
    if (row % n < n - 1)
      couple(row + 1, -1.0);
    if (row >= n)
      couple(row - n, -1.0);
    if (row < n * n - n)
      couple(row + n, -1.0);
  }
  a->fillComplete();

  const RCP<Vector> load = rcp(new Vector(map)), floor = rcp(new Vector(map));
  load->putScalar(-8 * h * h);
  floor->putScalar(-0.3);
  return {a, load, floor};
}
