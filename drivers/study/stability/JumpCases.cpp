/// Jumps of the material: between the bodies, along and across the borders of subdomains, element by element, and channels
/// through everything. Powers of ten from 1e-8 to 1e8.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

using Regions = std::vector<scene::Region>;

/// Where a membrane on a unit square has the conductivity 10^k; elsewhere it is 1.
using Pattern = Regions (*)(const scene::Body& body, double conductivity);

scene::Rectangle part(const scene::Body& body, double x0, double x1, double y0, double y1) {
  const scene::Rectangle& whole = body.rectangle;
  const double width = whole.x1 - whole.x0, height = whole.y1 - whole.y0;
  return {whole.x0 + x0 * width, whole.x0 + x1 * width, whole.y0 + y0 * height, whole.y0 + y1 * height};
}

/// The right body as a whole.
Regions oneBody(const scene::Body& body, double conductivity) {
  if (body.rectangle.x0 == 0)
    return {};
  return {{"all", body.rectangle, conductivity}};
}

/// Every other one of n × n squares.
Regions checkerboard(const scene::Body& body, double conductivity, int n) {
  Regions regions;
  for (int i = 0; i < n; ++i)
    for (int j = (i + 1) % 2; j < n; j += 2)
      regions.push_back({std::to_string(i) + "." + std::to_string(j),
                         part(body, 1.0 * i / n, (i + 1.0) / n, 1.0 * j / n, (j + 1.0) / n), conductivity});
  return regions;
}

/// Every other subdomain.
Regions alongBorders(const scene::Body& body, double conductivity) {
  return checkerboard(body, conductivity, body.decomposition.counts[0]);
}

/// Squares of 2 × 2 elements: as small as a jump can be on both sides of every border.
Regions insideSubdomains(const scene::Body& body, double conductivity) {
  return checkerboard(body, conductivity, body.elements[0] / 2);
}

/// Every other one of layers as high as half a subdomain, which begin and end inside subdomains.
Regions acrossBorders(const scene::Body& body, double conductivity) {
  Regions regions;
  const int n = body.decomposition.counts[1];
  for (int layer = 0; layer < n; ++layer)
    regions.push_back({"layer " + std::to_string(layer),
                       part(body, 0, 1, (layer + 0.25) / n, (layer + 0.75) / n), conductivity});
  return regions;
}

/// One element high, two a subdomain, from support to support through every border and the contact; no crosspoint lies on
/// any of them.
Regions channels(const scene::Body& body, double conductivity) {
  Regions regions;
  const int n = body.decomposition.counts[1];
  const double h = 1.0 / body.elements[1];
  for (int subdomain = 0; subdomain < n; ++subdomain)
    for (const int element : {1, body.elements[1] / n - 2}) {
      const double y = 1.0 * subdomain / n + element * h;
      regions.push_back({"channel at " + std::to_string(y), part(body, 0, 1, y, y + h), conductivity});
    }
  return regions;
}

struct NamedPattern {
  const char* name;
  Pattern pattern;
};

constexpr NamedPattern patterns[] = {{"jump between the bodies", oneBody},
                                     {"jumps along subdomain borders", alongBorders},
                                     {"jumps across subdomain borders", acrossBorders},
                                     {"checkerboard inside subdomains", insideSubdomains},
                                     {"channels through borders and contact", channels}};

/// What a problem with jumps is solved with. Other coarse spaces join here.
struct Variant {
  const char* name;
  Teuchos::ParameterList solver;
};

std::vector<Variant> variants() {
  return {{"default", Teuchos::ParameterList()}, {"plain", plainMethod()}};
}

std::vector<int> exponents(bool quick) {
  return quick ? std::vector<int>{-8, -4, 0, 4, 8} : std::vector<int>{-8, -6, -4, -2, 0, 2, 4, 6, 8};
}

/// The plain method's convergence depends on the condition of F, which the jump multiplies.
Expectation expectedOf(const std::string& variant, int exponent) {
  return variant == "plain" && std::abs(exponent) > 2 ? solvedOrStopped() : solved();
}

std::string powerOfTen(int exponent) {
  return "1e" + std::string(exponent < 0 ? "-" : "+") + std::to_string(std::abs(exponent));
}

StabilityCase jumpCase(const std::string& name, int exponent, const Variant& variant, ContactTask task) {
  task.solver = variant.solver;
  task.contrast = std::pow(10.0, std::abs(exponent));
  StabilityCase result{"jumps", name, powerOfTen(exponent), expectedOf(variant.name, exponent), {}};
  result.run = [task = std::move(task)](const RCP<const Comm>& comm) { return solveContact(task, comm); };
  result.value = std::pow(10.0, exponent);
  result.variant = variant.name;
  return result;
}

/// Every other subdomain, or the part of it, is 10^k times as stiff.
scene::Scene elasticCheckerboard(scene::Scene scene, int exponent) {
  for (scene::Body& body : scene.bodies) {
    scene::Solid& solid = *body.solid;
    scene::Material material = solid.material;
    material.youngsModulus *= std::pow(10.0, exponent);
    const auto [x0, y0, z0] = solid.mesh.box.lower;
    const auto [nx, ny, nz] = body.decomposition.counts;
    const bool isFlat = solid.physics != scene::Physics::elasticity3d;
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < (isFlat ? 1 : nz); ++k)
          if ((i + j + k) % 2 == 1) {
            scene::Box box;
            box.lower = {x0 + 1.0 * i / nx, y0 + 1.0 * j / ny, isFlat ? box.lower[2] : z0 + 1.0 * k / nz};
            box.upper = {x0 + (i + 1.0) / nx, y0 + (j + 1.0) / ny,
                         isFlat ? box.upper[2] : z0 + (k + 1.0) / nz};
            solid.regions.push_back({"stiff", box, "", material});
            solid.regions.back().name.append(std::to_string(solid.regions.size()));
          }
  }
  return scene;
}

} // namespace

StabilityCases jumpCases(bool quick) {
  StabilityCases cases;
  for (const Variant& variant : variants()) {
    for (const NamedPattern& named : patterns)
      for (const int exponent : exponents(quick)) {
        scene::Scene scene = membranes(true, quick ? 2 : 4, 8);
        for (scene::Body& body : scene.bodies)
          body.regions = named.pattern(body, std::pow(10.0, exponent));
        cases.push_back(jumpCase(named.name, exponent, variant, {scene}));
      }
    for (const int exponent : exponents(quick)) {
      scene::Scene scene = membranes(false, quick ? 2 : 4, quick ? 4 : 8);
      for (scene::Body& body : scene.bodies)
        body.regions = alongBorders(body, std::pow(10.0, exponent));
      cases.push_back(jumpCase("floating, jumps along borders", exponent, variant, {scene}));
      cases.push_back(jumpCase("elastic squares, along borders", exponent, variant,
                               {elasticCheckerboard(pressedSquares(2, quick ? 3 : 6), exponent)}));
      if (!quick || std::abs(exponent) == 8)
        cases.push_back(jumpCase("elastic cubes, along borders", exponent, variant,
                                 {elasticCheckerboard(pressedCubes(2, quick ? 2 : 3), exponent)}));
    }
  }
  return cases;
}

} // namespace epafi::drivers
