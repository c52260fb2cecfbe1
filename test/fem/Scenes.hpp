#pragma once

/// Small bodies for the tests of this room.

#include "epafi/base/Types.hpp"
#include "epafi/scene/Scene.hpp"

#include <numeric>
#include <vector>

namespace epafi::fem {

/// Rectangle (0,2) × (0,1) with 4 × 3 elements, nothing on it.
inline scene::Body plainBody() {
  scene::Body body;
  body.name = "plate";
  body.mesh.box = mesh::rectangle(0, 2, 0, 1);
  body.mesh.elements = {4, 3, 0};
  return body;
}

inline std::vector<GlobalOrdinal> allElements(GlobalOrdinal number) {
  std::vector<GlobalOrdinal> elements(number);
  std::iota(elements.begin(), elements.end(), GlobalOrdinal{0});
  return elements;
}

} // namespace epafi::fem
