// A thick ring under inner pressure (Lamé), a solution without singularities on a body with curved sides:
// errors fall as fast as the order of the elements lets them.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/mesh/MeshOrder.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace epafi {
namespace {

using namespace test;

constexpr double inner = 1, outer = 2, pressure = 3, young = 200, poisson = 0.3;

/// u_r = ((1 − 2ν) A r + B/r)(1 + ν)/E, σ_r = A − B/r², σ_θ = A + B/r², σ_z = 2νA.
fem::FieldValue lame(int /*body*/, const Point& point) {
  constexpr double share = inner * inner / (outer * outer - inner * inner), a = pressure * share,
                   b = a * outer * outer;
  const double r = std::hypot(point[0], point[1]), cosine = point[0] / r, sine = point[1] / r;
  const double u = ((1 - 2 * poisson) * a * r + b / r) * (1 + poisson) / young;
  const double radial = a - b / (r * r), around = a + b / (r * r);
  return {{u * cosine, u * sine, 0},
          {radial * cosine * cosine + around * sine * sine, radial * sine * sine + around * cosine * cosine,
           2 * poisson * a, (radial - around) * sine * cosine, 0, 0}};
}

/// A quarter of the ring: n elements across and n around, in space n/2 along the axis; all nodes where they
/// belong.
scene::Scene quarter(bool isSpace, Cut cut, int order, int n, const epafi::test::MeshFolder& folder) {
  const mesh::StructuredMesh square({{0, 0, 0}, {1, 1, 0.5}}, {n, n, isSpace ? n / 2 : 0});
  mesh::MeshArrays arrays = epafi::test::arraysOf(square, {}, cut);
  if (order == 2)
    arrays = completed(std::move(arrays), false);
  arrays.nodeTags.clear();
  for (std::size_t node = 0; node < arrays.points.size(); ++node) {
    arrays.nodeTags.push_back(static_cast<GlobalOrdinal>(node) + 1);
    Point& x = arrays.points[node];
    const double r = inner + (outer - inner) * x[0], angle = x[1] * std::numbers::pi / 2;
    x = {r * std::cos(angle), r * std::sin(angle), x[2]};
  }
  scene::Body ring;
  ring.name = "ring";
  ring.physics = isSpace ? Physics::elasticity3d : Physics::planeStrain;
  ring.material = {1.0, young, poisson, 1.0};
  ring.mesh.file = folder.write("ring" + std::to_string(n) + ".msh", epafi::test::fileOf(arrays));
  ring.mesh.group = "body";
  ring.mesh.order = 0;
  ring.decomposition = cutByMetis(4);
  ring.supports = {slide(isSpace ? "front" : "bottom"), slide(isSpace ? "back" : "top")};
  if (isSpace) {
    ring.supports.push_back(slide("bottom"));
    ring.supports.push_back(slide("top"));
  }
  ring.loads = {{"inside", fem::SolidLoad::Kind::pressure, {}, "left", {0, 0, 0}, {pressure, 0, 0}}};
  scene::Scene scene;
  scene.bodies = {ring};
  return scene;
}

class LameTest : public testing::TestWithParam<std::tuple<int, Cut, int>> {}; // dimension, elements, order

TEST_P(LameTest, EnergyAndL2ErrorsFallWithTheOrder) {
  const auto [dimension, cut, order] = GetParam();
  const epafi::test::MeshFolder folder;
  const bool isSpace = dimension == 3;
  std::vector<accuracy::ErrorNorms> errors;
  std::vector<double> effectivities;
  for (const int n : isSpace ? std::vector{4, 8} : std::vector{6, 12}) {
    const scene::Scene scene = quarter(isSpace, cut, order, n, folder);
    const SolidRun run(scene, 1e-11);
    errors.push_back(accuracy::errorNorms(scene, run.decomposition, run.solution.displacement, lame));
    const double estimate =
        accuracy::ErrorEstimator(scene, run.decomposition)(run.solution.displacement).discretisation;
    effectivities.push_back(estimate / errors.back().energy);
    EXPECT_GT(effectivities.back(), order == 1 ? 0.5 : 0.9) << n;
    // Patches of bricks lack points across the inside, where most of the error is.
    EXPECT_LT(effectivities.back(), order == 1 ? 2 : 4.2) << n;
  }
  if (order == 2) {
    EXPECT_LT(std::abs(effectivities[1] - 1), 0.5 * std::abs(effectivities[0] - 1) + 0.02);
    EXPECT_LT(effectivities[1], cut == Cut::simplices ? 1.2 : 2.5);
  }
  EXPECT_GT(std::log2(errors[0].energy / errors[1].energy), order - 0.15);
  EXPECT_GT(std::log2(errors[0].l2 / errors[1].l2), order + 1 - 0.2);
}

std::string nameOf(const testing::TestParamInfo<std::tuple<int, Cut, int>>& instance) {
  const auto& [dimension, cut, order] = instance.param;
  return std::array{"Bricks", "Simplices", "Prisms", "Pyramids", "Mixed"}.at(static_cast<std::size_t>(cut)) +
         std::to_string(dimension) + "d" + std::to_string(order);
}

INSTANTIATE_TEST_SUITE_P(Ring, LameTest,
                         testing::Combine(testing::Values(2),
                                          testing::Values(Cut::none, Cut::simplices, Cut::mixed),
                                          testing::Values(1, 2)),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(Solid, LameTest,
                         testing::Combine(testing::Values(3),
                                          testing::Values(Cut::none, Cut::simplices, Cut::prisms,
                                                          Cut::pyramids, Cut::mixed),
                                          testing::Values(1, 2)),
                         nameOf);

} // namespace
} // namespace epafi
