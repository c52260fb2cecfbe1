#pragma once

/// Matrices that are equal to the last bit: regular meshes and cuts make many. Found by comparing, never
/// assumed.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <cstdint>
#include <memory>
#include <unordered_map>

namespace epafi::decomposition {

/// Same shape, same pattern, the same bits in every value.
bool areEqual(const SparseMatrix& a, const SparseMatrix& b);

/// Equal for equal matrices, and rarely for others: of their size and some values.
std::uint64_t fingerprint(const SparseMatrix& matrix);

/// Stores equal matrices once. Nothing here is collective.
class EqualMatrices {
public:
  /// `matrix`, or the equal one that came before it. What is left in `matrix` is not specified; fill it anew.
  std::shared_ptr<const SparseMatrix> store(SparseMatrix& matrix);

private:
  std::unordered_multimap<std::uint64_t, std::shared_ptr<const SparseMatrix>> known_;
};

} // namespace epafi::decomposition
