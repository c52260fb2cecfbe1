#include "epafi/scene/Solid.hpp"

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

} // namespace epafi::scene
