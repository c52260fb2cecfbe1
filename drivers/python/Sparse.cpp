#include "Sparse.hpp"

#include "epafi/base/Errors.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace epafi::python {

RCP<const CrsMatrix> matrixOf(const CompressedRows& rows, int numColumns, const RCP<const Comm>& comm) {
  const auto& [ends, places, values] = rows;
  const auto numRows = static_cast<int>(ends.size()) - 1;
  const int *const starts = ends.data(), *const columns = places.data();
  if (numRows < 0 || starts[0] != 0 || !std::is_sorted(starts, starts + numRows + 1) ||
      starts[numRows] != places.size() || places.size() != values.size() ||
      std::any_of(columns, columns + places.size(),
                  [numColumns](int column) { return column < 0 || column >= numColumns; }))
    throw InputError("the arrays indptr, indices and data of a matrix do not fit each other");
  const RCP<const Map> range = rcp(new Map(numRows, 0, comm)), domain = rcp(new Map(numColumns, 0, comm));
  Teuchos::Array<std::size_t> counts(numRows);
  for (int row = 0; row < numRows; ++row)
    counts[row] = static_cast<std::size_t>(starts[row + 1] - starts[row]);
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(range, counts()));
  const std::vector<GlobalOrdinal> all(columns, columns + places.size());
  for (int row = 0; row < numRows; ++row)
    matrix->insertGlobalValues(row, starts[row + 1] - starts[row], values.data() + starts[row],
                               all.data() + starts[row]);
  matrix->fillComplete(domain, range);
  return matrix;
}

RCP<Vector> vectorOf(const Row<double>& values, const RCP<const Map>& map, const char* name) {
  if (static_cast<std::size_t>(values.size()) != map->getGlobalNumElements())
    throw InputError(std::string(name) + " has " + std::to_string(values.size()) +
                     " entries, but must have " + std::to_string(map->getGlobalNumElements()));
  const RCP<Vector> vector = rcp(new Vector(map));
  std::copy_n(values.data(), values.size(), vector->getDataNonConst().begin());
  return vector;
}

} // namespace epafi::python
