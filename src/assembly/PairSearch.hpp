#pragma once

/// Faces of different solids that lie close together, on the exact surfaces: facets around a pin would be off
/// by more than its clearance.

#include "epafi/assembly/Assembly.hpp"

namespace epafi::meshing {
class GmshSession;
}

namespace epafi::assembly {

struct PairSearch {
  double distance = 0; ///< up to which faces are a pair; 0: a thousandth of the assembly's diagonal
  double angle = 45;   ///< degrees: by how much outward normals may differ from being opposite

  [[nodiscard]] double distanceIn(const Assembly& assembly) const;
};

/// How much farther faces are told of as near misses.
constexpr double nearMissFactor = 5;

/// Share of the distance up to which facets may be off round surfaces: beyond that nobody can tell what is
/// near.
constexpr double smallSag = 0.25;

/// Fills in pairs and near misses, in the order of their faces. Faces are near by their least distance, not
/// by their area: a ball on a plane is.
void findPairs(const meshing::GmshSession& session, const PairSearch& search, Assembly& assembly);

} // namespace epafi::assembly
