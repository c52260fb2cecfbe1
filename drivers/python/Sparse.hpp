#pragma once

/// Matrices in compressed rows, as SciPy has them.

#include "epafi/base/Types.hpp"

#include <pybind11/numpy.h>

#include <tuple>

namespace epafi::python {

/// Numbers in a row, converted where they are of another type.
template <class T>
using Row = pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

/// Where each of n rows starts (n + 1), columns and values of the entries: indptr, indices, data.
using CompressedRows = std::tuple<Row<int>, Row<int>, Row<double>>;

/// The same on one rank. \throws InputError if starts or columns are none.
RCP<const CrsMatrix> matrixOf(const CompressedRows& rows, int numColumns, const RCP<const Comm>& comm);

/// A vector of one rank. \throws InputError for another size than the map's
RCP<Vector> vectorOf(const Row<double>& values, const RCP<const Map>& map, const char* name);

} // namespace epafi::python
