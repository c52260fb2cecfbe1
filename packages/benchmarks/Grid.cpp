#include "epafi/benchmarks/Grid.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <string>

namespace epafi::benchmarks {

Grid Grid::square(int n, double left, double right, double bottom, double top) {
  if (n < 1)
    throw InputError("a grid with " + std::to_string(n) +
                     " unknowns a side is asked for; it needs at least 1");
  return {n, n, left, bottom, (right - left) / (n + 1), (top - bottom) / (n + 1)};
}

RCP<const Map> Grid::map(const RCP<const Comm>& comm) const {
  return rcp(new Map(size(), 0, comm));
}

RCP<Vector> Grid::vector(const RCP<const Map>& map, const std::function<double(int, int)>& values) const {
  const RCP<Vector> result = rcp(new Vector(map));
  const auto entries = result->getDataNonConst();
  for (LocalOrdinal k = 0; k < entries.size(); ++k) {
    const auto [i, j] = place(map->getGlobalElement(k));
    entries[k] = values(i, j);
  }
  return result;
}

FivePointSystem assembleFivePoint(const Grid& grid, const RCP<const Comm>& comm,
                                  const std::function<Stencil(int, int)>& stencil,
                                  const std::function<double(int, int)>& load) {
  const RCP<const Map> map = grid.map(comm);
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(map, 5));
  const RCP<Vector> rightHandSide = grid.vector(map, load);
  for (const GlobalOrdinal row : localIndices(*map)) {
    const auto [i, j] = grid.place(row);
    const Stencil s = stencil(i, j);
    std::array<GlobalOrdinal, 5> columns{row};
    std::array<double, 5> values{s.centre};
    int count = 1;
    const auto addNeighbour = [&](int column, int line, double weight) {
      if (weight == 0 || column < 0 || column >= grid.nx || line < 0 || line >= grid.ny)
        return;
      columns.at(count) = column + static_cast<GlobalOrdinal>(grid.nx) * line;
      values.at(count) = weight;
      ++count;
    };
    addNeighbour(i, j - 1, s.south);
    addNeighbour(i - 1, j, s.west);
    addNeighbour(i + 1, j, s.east);
    addNeighbour(i, j + 1, s.north);
    matrix->insertGlobalValues(row, count, values.data(), columns.data());
  }
  matrix->fillComplete(map, map);
  return {matrix, rightHandSide};
}

Stencil laplaceStencil(const Grid& grid, int i, int j, double borderWeight) {
  const double alongX = -grid.hy / grid.hx, alongY = -grid.hx / grid.hy;
  Stencil s{0, alongX, alongX, alongY, alongY};
  if (i == 0)
    s.west *= borderWeight;
  if (i == grid.nx - 1)
    s.east *= borderWeight;
  if (j == 0)
    s.south *= borderWeight;
  if (j == grid.ny - 1)
    s.north *= borderWeight;
  s.centre = -(s.west + s.east + s.south + s.north);
  return s;
}

RCP<CrsMatrix> bilinearInterpolation(const Grid& coarse, const RCP<const Map>& coarseMap, const Grid& fine,
                                     const RCP<const Map>& fineMap) {
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(fineMap, 4));
  for (const GlobalOrdinal row : localIndices(*fineMap)) {
    const auto [i, j] = fine.place(row);
    // Where the point stands in coarse mesh widths; the border is at −1 and n.
    const double x = (fine.x(i) - coarse.left) / coarse.hx - 1,
                 y = (fine.y(j) - coarse.bottom) / coarse.hy - 1;
    const int column = static_cast<int>(std::floor(x)), line = static_cast<int>(std::floor(y));
    const double alongX = x - column, alongY = y - line;
    const auto add = [&](int ci, int cj, double weight) {
      if (weight == 0 || ci < 0 || ci >= coarse.nx || cj < 0 || cj >= coarse.ny)
        return;
      const GlobalOrdinal index = ci + static_cast<GlobalOrdinal>(coarse.nx) * cj;
      matrix->insertGlobalValues(row, 1, &weight, &index);
    };
    add(column, line, (1 - alongX) * (1 - alongY));
    add(column + 1, line, alongX * (1 - alongY));
    add(column, line + 1, (1 - alongX) * alongY);
    add(column + 1, line + 1, alongX * alongY);
  }
  matrix->fillComplete(coarseMap, fineMap);
  return matrix;
}

} // namespace epafi::benchmarks
