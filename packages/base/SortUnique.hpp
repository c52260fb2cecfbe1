#pragma once

/// Numbers, names or pairs in ascending order, each once.

#include <algorithm>

namespace epafi {

/// Sorts the values and takes out what stands there again. \param values  a std::vector
template <class Values>
void sortUnique(Values& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

} // namespace epafi
