#include "FrictionDraw.hpp"

#include "support/SolidScenes.hpp"

#include <algorithm>
#include <optional>

namespace epafi::test {
scene::Decomposition randomCut(Dice& dice, int dimension, int elements) {
  if (dice.upTo(3) == 0)
    return cutByMetis(1 + dice.upTo(4));
  const int most = std::min(2, elements);
  return cutInGrid({1 + dice.upTo(most), 1 + dice.upTo(most), dimension == 3 ? 1 + dice.upTo(2) : 1});
}

Draw drawn(unsigned seed, int dimension, Hold hold) {
  Dice dice(seed);
  Draw draw;
  draw.seed = seed;
  draw.dimension = dimension;
  draw.order = 1 + dice.upTo(2);
  draw.elements = dimension == 3 ? 2 : 2 + dice.upTo(5);
  const int n = draw.elements;
  const int law = dice.upTo(8); // mostly the two laws alone
  if (law < 5)
    draw.coefficient = dice.scaled(0.05, 1);
  if (law >= 4)
    draw.traction = dice.scaled(2e-4, 2e-2);
  if (dice.upTo(4) == 0)
    draw.jump = 1e-3;
  const double press = 0.01, holds = draw.coefficient * press + draw.traction;
  const bool isFree = hold != Hold::held && hold != Hold::slides;
  const double shear =
      isFree ? dice.between(-1.05, 1.05) * std::min(holds, 0.5 * press) : dice.between(-1, 1) * press;
  const double angle = dice.between(0, 1.5);
  const std::size_t vertical = static_cast<std::size_t>(dimension - 1);
  Vector3 top{shear, 0, 0}, up{0, 0, 0}, tilted{0, 0, 0};
  if (dimension == 3)
    top = {shear * std::cos(angle), shear * std::sin(angle), 0};
  top[vertical] = -press;
  up[vertical] = 1;

  const int deep = dimension == 3 ? n : 0;
  const double height = dice.upTo(3) == 0 ? 0.5 : 1;
  const auto body = [&](const std::string& name, double low, double high) {
    mesh::Box box{{0, 0, low}, {1, 1, high}};
    if (dimension == 2)
      box = {{0, low, 0}, {1, high, 0}};
    scene::Body made = block(name, box, {n, n, deep}, {});
    made.material.youngsModulus = name == "lower" ? dice.scaled(0.3, 10) : 1;
    made.material.poissonsRatio = dice.between(0, 0.4);
    made.mesh.order = draw.order;
    return made;
  };
  scene::Body upper = body("upper", 0, height);
  upper.loads.push_back(loadOn("top", top));
  if (dice.upTo(2) == 0)
    upper.loads.push_back(
        loadOn("left", {(isFree ? 0.5 * std::min(holds, 0.5 * press) : press) * dice.between(-1, 1), 0, 0},
               fem::SolidLoad::Kind::pressure));
  if (dice.upTo(4) == 0) {
    Vector3 weight{0, 0, 0};
    weight[vertical] = -press * dice.between(0, 0.5);
    upper.loads.push_back(test::weight(weight));
  }
  std::optional<double> none;
  if (hold == Hold::held) {
    if (dice.upTo(2) == 0) {
      fem::SolidSupport push{"push", "top", {dice.between(-0.006, 0.006), 0.0, 0.0}};
      push.value[vertical] = dice.between(-0.012, -0.004);
      if (dimension == 3)
        push.value[1] = dice.between(-0.006, 0.006);
      upper.supports.push_back(push);
      upper.loads.erase(upper.loads.begin());
    } else {
      upper.supports.push_back({"wall", "left", {0.0, 0.0, 0.0}});
    }
  } else if (hold == Hold::slides) {
    upper.supports.push_back(slide("left", dice.between(-0.002, 0.002)));
    if (dimension == 3)
      upper.supports.push_back(slide("front"));
  }
  draw.scene.bodies.push_back(upper);
  tilted = up;
  if (dice.upTo(3) == 0)
    tilted[0] = dice.between(-0.02, 0.02);
  double length = 0;
  for (const double component : tilted)
    length += component * component;
  for (double& component : tilted)
    component /= std::sqrt(length);
  if (hold == Hold::pair || hold == Hold::stack) {
    draw.scene.bodies.push_back(body("lower", -1, 0));
    draw.scene.contacts.push_back(between("joint", 0, "bottom", 1, "top"));
    draw.scene.contacts.back().coupling = scene::SurfaceContact::Coupling::nodes;
    draw.scene.contacts.back().gap = dice.upTo(3) == 0 ? dice.between(-0.001, 0.001) : 0;
    if (hold == Hold::pair)
      draw.scene.bodies.back().supports.push_back({"foot", "bottom", {0.0, 0.0, 0.0}});
    else {
      Vector3 low{0, 0, 0};
      low[vertical] = -1;
      draw.scene.contacts.push_back(onPlane("floor", 1, "bottom", low, tilted));
    }
  } else {
    draw.scene.contacts.push_back(onPlane("floor", 0, "bottom", {0, 0, 0}, tilted));
    draw.scene.contacts.back().gap = dice.upTo(3) == 0 ? dice.between(-0.001, 0.001) : 0;
  }
  draw.words = "seed " + std::to_string(seed) + ", " + std::to_string(dimension) + "-D, order " +
               std::to_string(draw.order) + ", n = " + std::to_string(n) + ", mu " +
               std::to_string(draw.coefficient) + ", bound " + std::to_string(draw.traction) + ", jump " +
               std::to_string(draw.jump) + ", shear " + std::to_string(shear);
  return draw;
}

} // namespace epafi::test
