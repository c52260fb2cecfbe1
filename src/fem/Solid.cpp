#include "epafi/fem/Solid.hpp"

#include <utility>

namespace epafi::fem {

namespace {

struct Entry {
  const char* name;
  int components, dimension;
};

const Entry& entryOf(Physics physics) {
  static constexpr std::array<Entry, 4> entries{{{"membrane", 1, 2}, // in the order of Physics
                                                 {"plane strain", 2, 2},
                                                 {"plane stress", 2, 2},
                                                 {"elasticity 3-D", 3, 3}}};
  return entries[static_cast<std::size_t>(physics)];
}

} // namespace

std::string toString(Physics physics) {
  return entryOf(physics).name;
}

int componentsOf(Physics physics) {
  return entryOf(physics).components;
}

int dimensionOf(Physics physics) {
  return entryOf(physics).dimension;
}

SolidLoad loadInside(std::string name, const mesh::Box& box, double value) {
  return {std::move(name), SolidLoad::Kind::body, box, "", {0, 0, 0}, {value, 0, 0}, false};
}

} // namespace epafi::fem
