#include "epafi/benchmarks/Interpolation.hpp"

#include "epafi/base/Compatibility.hpp"

#include <Tpetra_CrsMatrix.hpp>

#include <cmath>

namespace epafi::benchmarks {

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
