#include "epafi/benchmarks/Grid.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <string>

namespace epafi::benchmarks {
namespace {

void requireUnknowns(int n) {
  if (n < 1)
    throw InputError("a grid with " + std::to_string(n) +
                     " unknowns a side is asked for; it needs at least 1");
}

} // namespace

Grid Grid::square(int n, double left, double right, double bottom, double top) {
  requireUnknowns(n);
  return {n, n, left, bottom, (right - left) / (n + 1), (top - bottom) / (n + 1)};
}

Grid Grid::line(int n, double left, double right) {
  requireUnknowns(n);
  return {n, 1, left, 0, (right - left) / (n + 1), 0};
}

RCP<const Map> Grid::map(const RCP<const Comm>& comm) const {
  return rcp(new Map(static_cast<Tpetra::global_size_t>(size()), 0, comm));
}

RCP<Vector> Grid::vector(const RCP<const Map>& map, const std::function<double(int, int)>& values) const {
  const RCP<Vector> result = rcp(new Vector(map));
  const auto entries = result->getDataNonConst();
  for (Teuchos_Ordinal k = 0; k < entries.size(); ++k) {
    const auto [i, j] = place(map->getGlobalElement(static_cast<LocalOrdinal>(k)));
    entries[k] = values(i, j);
  }
  return result;
}

FivePointSystem assembleFivePoint(const Grid& grid, const RCP<const Comm>& comm,
                                  const std::function<Stencil(int, int)>& stencil,
                                  const std::function<double(int, int)>& load,
                                  const std::function<double(double, double)>& border) {
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
      if (weight == 0)
        return;
      if (column < 0 || column >= grid.nx || line < 0 || line >= grid.ny) {
        if (border)
          rightHandSide->sumIntoGlobalValue(row, -weight * border(grid.x(column), grid.y(line)));
        return;
      }
      columns.at(static_cast<std::size_t>(count)) = column + static_cast<GlobalOrdinal>(grid.nx) * line;
      values.at(static_cast<std::size_t>(count)) = weight;
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

} // namespace epafi::benchmarks
