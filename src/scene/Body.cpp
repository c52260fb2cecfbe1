#include "epafi/scene/Body.hpp"

#include <utility>

namespace epafi::scene {

std::string toString(Physics physics) {
  switch (physics) {
  case Physics::membrane:
    return "membrane";
  case Physics::planeStrain:
    return "plane strain";
  case Physics::planeStress:
    return "plane stress";
  case Physics::elasticity3d:
    return "elasticity 3-D";
  }
  return "";
}

int componentsOf(Physics physics) {
  switch (physics) {
  case Physics::membrane:
    return 1;
  case Physics::planeStrain:
  case Physics::planeStress:
    return 2;
  case Physics::elasticity3d:
    return 3;
  }
  return 0;
}

int dimensionOf(Physics physics) {
  return physics == Physics::elasticity3d ? 3 : 2;
}

bool isMembraneOnRectangle(const Body& body) {
  return body.physics == Physics::membrane && body.mesh.file.empty();
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
