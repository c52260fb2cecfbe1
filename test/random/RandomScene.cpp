#include "RandomScene.hpp"

#include "RandomNumbers.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace epafi::test {
namespace {

/// The sizes that all draws of a scene refer to.
struct Sizes {
  double length = 1, stiffness = 1, strain = 1e-3;
  [[nodiscard]] double displacement() const { return strain * length; }
  [[nodiscard]] double pressure() const { return strain * stiffness; }
};

std::vector<std::string> sidesOf(int dimension) {
  return dimension == 2 ? std::vector<std::string>{"left", "right"}
                        : std::vector<std::string>{"left", "right", "front", "back"};
}

/// Along one of the axes, or anywhere.
Vector3 drawnDirection(int dimension, RandomNumbers& random) {
  Vector3 direction = Vector3::Zero();
  if (random.chance(0.6))
    direction[random.index(dimension)] = random.oneOf({-1.0, 1.0});
  else
    for (int d = 0; d < dimension; ++d)
      direction[d] = random.uniform(-1, 1);
  return direction;
}

void drawShape(DrawnScene& scene, const Sizes& sizes, RandomNumbers& random) {
  const int up = scene.dimension - 1, count = 1 + random.index(scene.dimension == 2 ? 3 : 2);
  const bool matching = random.chance(0.6), simplices = random.chance(0.4), equalOrders = random.chance(0.8);
  const int most = scene.dimension == 2 ? 4 : 2;
  const bool isFile = simplices || scene.canTurn();
  Vector3 extent = Vector3::Zero();
  std::array<int, 3> elements{0, 0, 0};
  const auto drawElements = [&] {
    for (int d = 0; d < scene.dimension; ++d)
      elements[d] = 1 + random.index(most);
  };
  for (int d = 0; d < scene.dimension; ++d)
    extent[d] = sizes.length * (random.chance(0.5) ? 1.0 : random.uniform(0.5, 1.5));
  drawElements();
  double height = 0;
  int order = random.chance(0.65) ? 1 : 2;
  for (int b = 0; b < count; ++b) {
    DrawnBody body;
    body.lower = Vector3::Zero();
    body.upper = extent;
    if (!matching) {
      drawElements();
      if (b > 0 && random.chance(0.4)) {
        body.upper[0] *= random.uniform(0.5, 0.9);
        body.lower[0] = random.chance(0.5) ? 0.0 : 0.1 * extent[0];
      }
    }
    if (!equalOrders)
      order = 1 + random.index(2);
    body.lower[up] = height;
    body.upper[up] = height += sizes.length * (random.chance(0.5) ? 1.0 : random.uniform(0.3, 1.2));
    body.elements = elements;
    body.order = order;
    body.isSimplex = simplices;
    body.isFile = isFile || random.chance(0.2);
    body.youngsModulus = sizes.stiffness * (random.chance(0.6) ? 1.0 : random.magnitude(-2, 2));
    body.poissonsRatio = random.oneOf({0.0, 0.2, 0.3, 0.3, 0.45});
    scene.bodies.push_back(body);
  }
}

/// Jumps of the stiffness inside of bodies; their boxes lie along the axes.
void drawRegions(DrawnBody& body, RandomNumbers& random) {
  const int count = 1 + random.index(2);
  for (int r = 0; r < count; ++r) {
    DrawnRegion region{body.lower, body.upper, body.youngsModulus * random.magnitude(-3.5, 3.5)};
    for (int d = 0; d < 3; ++d)
      if (const int n = body.elements[d]; n > 1 && random.chance(0.6)) {
        const double border = 1 + random.index(n - 1) + random.oneOf({0.0, 0.2, -0.3});
        (random.chance(0.5) ? region.lower[d] : region.upper[d]) =
            body.lower[d] + border / n * (body.upper[d] - body.lower[d]);
      }
    body.regions.push_back(region);
  }
}

void drawSupports(DrawnScene& scene, DrawnBody& body, const Sizes& sizes, bool turned,
                  RandomNumbers& random) {
  std::vector<std::string> surfaces = sidesOf(scene.dimension);
  for (const char* const surface : {"bottom", "top"}) // where others touch it, too
    if (random.chance(0.2))
      surfaces.emplace_back(surface);
  const auto value = [&] { return random.chance(0.8) ? 0.0 : sizes.displacement() * random.uniform(-1, 1); };
  const auto add = [&](int kind) {
    DrawnSupport support;
    support.surface = surfaces[random.index(static_cast<int>(surfaces.size()))];
    for (const DrawnSupport& other : body.supports)
      if (other.surface == support.surface)
        return;
    if (kind == 0)
      support.normal = value();
    else if (kind == 1)
      for (int d = 0; d < scene.dimension; ++d)
        support.value[d] = value();
    else
      support.value[random.index(scene.dimension)] = value();
    body.supports.push_back(support);
  };
  const int style = random.index(10);
  if (style < 2)
    return;
  add(style < 7 ? 0 : style < 8 || turned ? 1 : 2);
  if (style == 5 || style == 6)
    add(0);
  if (scene.dimension == 3 && random.chance(0.5))
    add(0);
}

DrawnLoad drawnLoad(const DrawnScene& scene, const DrawnBody& body, const Sizes& sizes,
                    RandomNumbers& random) {
  DrawnLoad load;
  load.kind = random.oneOf({"body", "traction", "traction", "pressure", "pressure", "point"});
  const double size = sizes.pressure() * random.uniform(0.5, 2);
  std::vector<std::string> surfaces = sidesOf(scene.dimension);
  surfaces.insert(surfaces.end(), {"top", "top", "bottom"});
  load.surface = surfaces[random.index(static_cast<int>(surfaces.size()))];
  load.force = size * drawnDirection(scene.dimension, random);
  if (load.kind == "pressure")
    load.force = {size * random.oneOf({1.0, 1.0, -1.0}), 0, 0};
  if (load.kind == "body")
    load.force /= sizes.length;
  if (load.kind == "point") {
    load.force *= std::pow(sizes.length, scene.dimension - 1) * 0.3;
    for (int d = 0; d < scene.dimension; ++d)
      load.point[d] = random.chance(0.5) ? body.lower[d] : body.upper[d];
  }
  return load;
}

void drawObstacle(DrawnScene& scene, int body, const std::string& surface, const Sizes& sizes,
                  RandomNumbers& random) {
  const DrawnBody& block = scene.bodies[body];
  static const std::vector<std::string> names{"left", "right", "front", "back", "bottom", "top"};
  const auto place = std::find(names.begin(), names.end(), surface) - names.begin();
  const int axis = place >= 4 ? scene.dimension - 1 : static_cast<int>(place / 2);
  const bool isLower = place % 2 == 0;
  DrawnContact contact;
  contact.first = body;
  contact.firstSurface = surface;
  contact.normal[axis] = isLower ? 1 : -1;
  for (int d = 0; d < scene.dimension; ++d)
    contact.point[d] = 0.5 * (block.lower[d] + block.upper[d]);
  contact.point[axis] = isLower ? block.lower[axis] : block.upper[axis];
  if (random.chance(0.25)) { // a circle or sphere that touches the surface somewhere
    contact.radius = sizes.length * random.uniform(1, 15);
    for (int d = 0; d < scene.dimension; ++d)
      if (d != axis)
        contact.point[d] = random.uniform(block.lower[d], block.upper[d]);
    contact.point -= contact.radius * contact.normal;
  } else if (random.chance(0.15)) // aslant
    for (int d = 0; d < scene.dimension; ++d)
      contact.normal[d] += sizes.strain * random.uniform(-1, 1);
  if (random.chance(0.4))
    contact.gap = sizes.displacement() * random.uniform(-1, 1);
  scene.contacts.push_back(contact);
}

void drawContacts(DrawnScene& scene, const Sizes& sizes, RandomNumbers& random) {
  const int count = static_cast<int>(scene.bodies.size());
  if (random.chance(0.8))
    drawObstacle(scene, 0, "bottom", sizes, random);
  for (int b = 0; b + 1 < count; ++b) {
    DrawnContact contact;
    contact.first = b;
    contact.second = b + 1;
    contact.firstSurface = "top";
    contact.secondSurface = "bottom";
    contact.isTied = random.chance(0.3);
    if (random.chance(0.3)) {
      std::swap(contact.first, contact.second);
      std::swap(contact.firstSurface, contact.secondSurface);
    }
    if (random.chance(0.3)) {
      contact.coupling = "mortar";
      contact.multipliers = random.oneOf({"auto", "first", "second"});
    }
    if (!contact.isTied && random.chance(0.4))
      contact.gap = sizes.displacement() * random.uniform(-1, 1);
    scene.contacts.push_back(contact);
  }
  if (random.chance(0.2))
    drawObstacle(scene, count - 1, "top", sizes, random);
  for (int b = 0; b < count; ++b)
    for (const std::string& side : sidesOf(scene.dimension))
      if (random.chance(0.12))
        drawObstacle(scene, b, side, sizes, random);
}

} // namespace

bool DrawnScene::canTurn() const {
  return std::all_of(bodies.begin(), bodies.end(), [&](const DrawnBody& body) {
    return body.regions.empty() &&
           std::all_of(body.supports.begin(), body.supports.end(), [&](const DrawnSupport& support) {
             const auto held = std::count_if(support.value.begin(), support.value.end(),
                                             [](const auto& value) { return value.has_value(); });
             return held == 0 || held == dimension;
           });
  });
}

DrawnScene drawnScene(std::uint64_t seed, int maxRanks) {
  RandomNumbers random(seed);
  DrawnScene scene;
  scene.dimension = random.chance(0.6) ? 2 : 3;
  scene.physics = scene.dimension == 3 ? "elasticity 3-D" : random.oneOf({"plane strain", "plane stress"});
  const bool turned = random.chance(0.5);
  const Sizes sizes{random.magnitude(-2, 2), random.magnitude(0, 5), random.magnitude(-5, -3)};
  drawShape(scene, sizes, random);
  const bool jumps = !turned && random.chance(0.3), pressed = random.chance(0.7);
  for (DrawnBody& body : scene.bodies) {
    body.isFile = body.isFile || turned;
    if (jumps)
      drawRegions(body, random);
    drawSupports(scene, body, sizes, turned, random);
    for (int load = random.index(3); load > 0; --load)
      body.loads.push_back(drawnLoad(scene, body, sizes, random));
  }
  if (pressed)
    scene.bodies.back().loads.push_back({"pressure", "top", {0, 0, 0}, {5 * sizes.pressure(), 0, 0}});
  drawContacts(scene, sizes, random);
  if (turned) {
    const double degrees = random.chance(0.5) ? random.oneOf({10.0, 30.0, 45.0, 53.0, 60.0, 75.0, 180.0})
                                              : random.uniform(0, 360);
    scene = movedTo(std::move(scene), degrees * std::numbers::pi / 180, random.uniform(0, 5));
  }
  drawCuts(scene, seed + 1);
  drawSolver(scene, seed + 2);
  scene.ranks = 1 + random.index(maxRanks);
  return scene;
}

} // namespace epafi::test
