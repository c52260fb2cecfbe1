#pragma once

/// Two bodies in contact whose stiffness jumps, along the cut into subdomains or across it.

#include "epafi/scene/Scene.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

/// Where the bodies are stiffer. Cut by a grid of subdomains of m × m elements, the first two follow the cut.
enum class Pattern {
  stripes,      ///< every other column of subdomains
  checkerboard, ///< every other subdomain
  channels,     ///< two strips, an element wide, through every row of subdomains and up to the contact
  crossing,     ///< the same through every column as well
  inclusions    ///< two short strips, 4 × 1 elements, across every edge between subdomains
};
std::string toString(Pattern pattern);

/// What the bodies are.
enum class Bodies {
  heldMembranes,    ///< the model problem of the paper
  floatingMembrane, ///< the same, the right one without support
  heldBlocks,       ///< plane strain; the right one is pressed to the left below
  slidingBlock      ///< the same, the right one on a foot along which it slides: it floats
};
std::string toString(Bodies bodies);

struct HeterogeneousScene {
  Bodies bodies = Bodies::heldMembranes;
  Pattern pattern = Pattern::channels;
  double jump = 1;      ///< factor of conductivity or Young's modulus in the pattern
  int cuts = 4;         ///< subdomains a side of each body
  int elements = 16;    ///< a side of each subdomain, at least 8
  bool byMetis = false; ///< cut into cuts² parts by METIS instead

  [[nodiscard]] scene::Scene build() const;
};

/// Two elastic cubes in space, the upper one on the lower one and held by two sliding planes, so that it floats; with a stiff
/// column, an element squared, through the middle of each of the 2 × 2 × 2 subdomains, upwards.
scene::Scene cubesWithColumns(double jump, int elementsOfSubdomain);

} // namespace epafi::drivers
