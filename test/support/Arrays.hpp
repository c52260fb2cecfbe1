#pragma once

/// Arrays as parameters hold them. (Teuchos::Array's constructors make two numbers in braces ambiguous.)

#include <Teuchos_Array.hpp>

#include <vector>

namespace epafi::test {

inline Teuchos::Array<double> numbers(const std::vector<double>& values) {
  return Teuchos::Array<double>(values);
}
inline Teuchos::Array<int> counts(const std::vector<int>& values) {
  return Teuchos::Array<int>(values);
}

} // namespace epafi::test
