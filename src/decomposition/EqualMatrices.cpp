#include "epafi/decomposition/EqualMatrices.hpp"

#include <algorithm>
#include <cstring>

namespace epafi::decomposition {
namespace {

template <class T>
bool areEqual(const T* a, const T* b, Eigen::Index count) {
  return count == 0 || std::memcmp(a, b, count * sizeof(T)) == 0;
}

} // namespace

bool areEqual(const SparseMatrix& a, const SparseMatrix& b) {
  return &a == &b || (a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
                      areEqual(a.outerIndexPtr(), b.outerIndexPtr(), a.outerSize() + 1) &&
                      areEqual(a.innerIndexPtr(), b.innerIndexPtr(), a.nonZeros()) &&
                      areEqual(a.valuePtr(), b.valuePtr(), a.nonZeros()));
}

std::uint64_t fingerprint(const SparseMatrix& matrix) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto mix = [&hash](std::uint64_t value) {
    hash = (hash ^ value) * 0x100000001b3ULL;
    hash ^= hash >> 29U;
  };
  mix(matrix.nonZeros());
  for (Eigen::Index i = 0; i < matrix.nonZeros(); i += 1 + matrix.nonZeros() / 64) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, matrix.valuePtr() + i, sizeof bits);
    mix(bits);
  }
  return hash;
}

std::shared_ptr<const SparseMatrix> EqualMatrices::store(SparseMatrix& matrix) {
  const std::uint64_t hash = fingerprint(matrix);
  const auto [first, last] = known_.equal_range(hash);
  const auto same =
      std::find_if(first, last, [&](const auto& candidate) { return areEqual(*candidate.second, matrix); });
  if (same != last)
    return same->second;
  const auto stored = std::make_shared<SparseMatrix>();
  stored->swap(matrix); // Eigen 3.4 cannot move sparse matrices
  return known_.emplace(hash, stored)->second;
}

} // namespace epafi::decomposition
