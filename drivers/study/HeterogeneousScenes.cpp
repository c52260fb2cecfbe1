#include "HeterogeneousScenes.hpp"

#include "epafi/scene/ModelProblem.hpp"

#include <algorithm>

namespace epafi::drivers {
namespace {

using scene::Rectangle;

/// First elements of two strips in a row of subdomains.
std::vector<int> stripsOf(int row, int elements) {
  return {row * elements + elements / 4, row * elements + 3 * elements / 4};
}

/// Short strips across the inner edges of the unit square's subdomains.
std::vector<Rectangle> inclusions(int cuts, int elements) {
  const double h = 1.0 / (cuts * elements);
  std::vector<Rectangle> boxes;
  for (int edge = 1; edge < cuts; ++edge)
    for (int row = 0; row < cuts; ++row)
      for (const int strip : stripsOf(row, elements)) {
        const double across = edge * elements * h;
        boxes.push_back({across - 2 * h, across + 2 * h, strip * h, (strip + 1) * h});
        boxes.push_back({strip * h, (strip + 1) * h, across - 2 * h, across + 2 * h});
      }
  return boxes;
}

/// In the unit square.
std::vector<Rectangle> boxesOf(Pattern pattern, int cuts, int elements) {
  if (pattern == Pattern::inclusions)
    return inclusions(cuts, elements);
  const double size = 1.0 / cuts, h = size / elements;
  std::vector<Rectangle> boxes;
  for (int i = 0; i < cuts; ++i) {
    if (pattern == Pattern::stripes && i % 2 == 0)
      boxes.push_back({i * size, (i + 1) * size, 0, 1});
    for (int j = i % 2; pattern == Pattern::checkerboard && j < cuts; j += 2)
      boxes.push_back({i * size, (i + 1) * size, j * size, (j + 1) * size});
    for (const int strip : stripsOf(i, elements)) {
      if (pattern == Pattern::channels || pattern == Pattern::crossing)
        boxes.push_back({0, 1, strip * h, (strip + 1) * h});
      if (pattern == Pattern::crossing)
        boxes.push_back({strip * h, (strip + 1) * h, 0, 1});
    }
  }
  return boxes;
}

scene::Decomposition cutOf(const HeterogeneousScene& what) {
  scene::Decomposition cut;
  cut.counts = {what.cuts, what.cuts};
  if (what.byMetis) {
    cut.method = scene::Decomposition::Method::metis;
    cut.parts = what.cuts * what.cuts;
  }
  return cut;
}

/// [0, 1]² or [1, 2] × [0, 1] of an elastic body.
scene::Body block(const HeterogeneousScene& what, double x) {
  scene::Solid solid;
  solid.physics = scene::Physics::planeStrain;
  solid.mesh.box = {{x, 0, 0}, {x + 1, 1, 0}};
  solid.mesh.elements = {what.cuts * what.elements, what.cuts * what.elements, 0};
  for (const Rectangle& box : boxesOf(what.pattern, what.cuts, what.elements)) {
    scene::SolidRegion region;
    region.name = "region " + std::to_string(solid.regions.size());
    region.box.lower = {x + box.x0, box.y0, region.box.lower[2]};
    region.box.upper = {x + box.x1, box.y1, region.box.upper[2]};
    region.material = solid.material;
    region.material.youngsModulus *= what.jump;
    solid.regions.push_back(region);
  }
  scene::Body body;
  body.name = x == 0 ? "left" : "right";
  body.solid = solid;
  body.decomposition = cutOf(what);
  return body;
}

/// A force per area in a box of the plane.
scene::SolidLoad force(const Rectangle& box, double x, double y) {
  scene::SolidLoad load;
  load.name = "force";
  load.box.lower = {box.x0, box.y0, load.box.lower[2]};
  load.box.upper = {box.x1, box.y1, load.box.upper[2]};
  load.value = {x, y, 0};
  return load;
}

scene::Scene blocks(const HeterogeneousScene& what) {
  scene::Scene scene;
  scene.bodies = {block(what, 0), block(what, 1)};
  scene::Solid &left = *scene.bodies[0].solid, &right = *scene.bodies[1].solid;
  left.supports = {{"wall", "left", {0.0, 0.0, std::nullopt}}};
  left.loads = {force({0, 1, 0.75, 1}, 1, 0.3)};
  right.supports = {what.bodies == Bodies::slidingBlock
                        ? scene::SolidSupport{"foot", "bottom", {std::nullopt, 0.0, std::nullopt}}
                        : scene::SolidSupport{"wall", "right", {0.0, 0.0, std::nullopt}}};
  right.loads = {force({1, 2, 0, 0.25}, -3, -0.9)};
  scene::SurfaceContact contact;
  contact.name = "interface";
  contact.firstSurface = "right";
  contact.second = 1;
  contact.secondSurface = "left";
  scene.surfaceContacts = {contact};
  return scene;
}

scene::Scene membranes(const HeterogeneousScene& what) {
  scene::Scene scene =
      scene::modelProblem(what.bodies == Bodies::heldMembranes, what.cuts, what.cuts * what.elements);
  for (scene::Body& body : scene.bodies) {
    body.decomposition = cutOf(what);
    for (const Rectangle& box : boxesOf(what.pattern, what.cuts, what.elements)) {
      const double x = body.rectangle.x0;
      body.regions.push_back({"region " + std::to_string(body.regions.size()),
                              {x + box.x0, x + box.x1, box.y0, box.y1},
                              what.jump});
    }
  }
  return scene;
}

/// A cube of side 1 that stands at height z.
scene::Body cube(double z, double jump, int elements) {
  scene::Solid solid;
  solid.mesh.box = {{0, 0, z}, {1, 1, z + 1}};
  solid.mesh.elements = {2 * elements, 2 * elements, 2 * elements};
  const double h = 0.5 / elements;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      scene::SolidRegion region;
      region.name = "column " + std::to_string(solid.regions.size());
      const int middle = elements / 2;
      const double x = 0.5 * i + h * middle, y = 0.5 * j + h * middle;
      region.box = {{x, y, z}, {x + h, y + h, z + 1}};
      region.material.youngsModulus = jump;
      solid.regions.push_back(region);
    }
  scene::Body body;
  body.name = z == 0 ? "lower" : "upper";
  body.solid = solid;
  body.decomposition.counts = {2, 2, 2};
  return body;
}

} // namespace

std::string toString(Pattern pattern) {
  return std::vector<std::string>{"stripes", "checkerboard", "channels", "crossing",
                                  "inclusions"}[static_cast<std::size_t>(pattern)];
}

std::string toString(Bodies bodies) {
  return std::vector<std::string>{"held membranes", "floating membrane", "held blocks",
                                  "sliding block"}[static_cast<std::size_t>(bodies)];
}

scene::Scene HeterogeneousScene::build() const {
  scene::Scene scene = bodies == Bodies::heldMembranes || bodies == Bodies::floatingMembrane
                           ? membranes(*this)
                           : blocks(*this);
  scene.title = toString(bodies) + ", " + toString(pattern);
  return scene;
}

scene::Scene cubesWithColumns(double jump, int elementsOfSubdomain) {
  scene::Scene scene;
  scene.title = "cubes with columns";
  scene.bodies = {cube(0, jump, elementsOfSubdomain), cube(1, jump, elementsOfSubdomain)};
  scene::Solid &lower = *scene.bodies[0].solid, &upper = *scene.bodies[1].solid;
  lower.supports = {{"floor", "bottom", {0.0, 0.0, 0.0}}};
  upper.supports = {{"plane x", "left", {0.0, std::nullopt, std::nullopt}},
                    {"plane y", "front", {std::nullopt, 0.0, std::nullopt}}};
  scene::SolidLoad weight;
  weight.name = "weight";
  weight.box.upper[0] = 0.5;
  weight.value = {0, 0, -1};
  upper.loads = {weight};
  scene::SurfaceContact contact;
  contact.name = "joint";
  contact.firstSurface = "top";
  contact.second = 1;
  contact.secondSurface = "bottom";
  scene.surfaceContacts = {contact};
  return scene;
}

} // namespace epafi::drivers
