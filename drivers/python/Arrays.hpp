#pragma once

/// Vectors as numpy's arrays, without a copy, and lists of parameters as dictionaries.

#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

namespace epafi::python {

namespace py = pybind11;

/// numpy's array of the shape, which owns the numbers from now on.
template <class T>
py::array_t<T> arrayOf(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  auto* const owned = new std::vector<T>(std::move(values));
  const py::capsule owner(owned, [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
  return py::array_t<T>(shape, owned->data(), owner);
}

/// Of so many columns; 0: a plain one.
template <class T>
py::array_t<T> arrayOf(std::vector<T>&& values, int columns = 0) {
  const auto size = static_cast<py::ssize_t>(values.size());
  if (columns == 0)
    return arrayOf(std::move(values), std::vector<py::ssize_t>{size});
  return arrayOf(std::move(values), std::vector<py::ssize_t>{size / columns, columns});
}

/// A list and its sublists as nested dictionaries.
py::dict dictOf(const Teuchos::ParameterList& list);

/// A schema likewise: of a parameter its type, its default as text and what it means, of a list its
/// dictionary and, under the empty name, its meaning.
py::dict schemaOf(const Teuchos::ParameterList& schema);

/// That of mpi4py, by the address of its handle; 0: that of all ranks.
RCP<const Comm> communicator(std::uintptr_t address);

} // namespace epafi::python
