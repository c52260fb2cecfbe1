#pragma once

/// Where iterations for eigenvalues start.

#include "epafi/base/Compatibility.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <cstdint>

namespace epafi::qp {

/// In (−1, 1), and hardly the same for two numbers (a 64-bit mixing function).
inline double pseudoRandom(GlobalOrdinal number) {
  auto z = static_cast<std::uint64_t>(number) + 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  z ^= z >> 31U;
  return 2.0 * (static_cast<double>(z >> 11U) / 9007199254740992.0) - 1.0;
}

/// Pseudo-random entries that depend on the global index alone.
inline void fillFromIndices(Vector& x) {
  const auto indices = localIndices(*x.getMap());
  const std::span<double> values = localDataNonConst(x);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = pseudoRandom(indices[static_cast<Teuchos_Ordinal>(i)]);
}

} // namespace epafi::qp
