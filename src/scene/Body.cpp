#include "epafi/scene/Body.hpp"

#include <utility>

namespace epafi::scene {

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

bool isMembraneOnRectangle(const Body& body) {
  return body.physics == Physics::membrane && body.mesh.file.empty();
}

bool isSplit(const std::string& file) {
  return file.find('*', file.rfind('/') + 1) != std::string::npos; // npos + 1 is 0
}

Box rectangle(double x0, double x1, double y0, double y1) {
  Box box;
  box.lower = {x0, y0, box.lower[2]};
  box.upper = {x1, y1, box.upper[2]};
  return box;
}

SolidLoad loadInside(std::string name, const Box& box, double value) {
  return {std::move(name), SolidLoad::Kind::body, box, "", {0, 0, 0}, {value, 0, 0}, false};
}

} // namespace epafi::scene
