// The largest pressure of a contact from its multipliers: exact where the pressure is quadratic round its
// peak, whatever the order of the elements, the cut, the ranks, and the place of the peak among the nodes.

#include "support/ElasticSample.hpp"

#include "epafi/simulation/LargestPressure.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <vector>

namespace epafi::simulation {
namespace {

constexpr int cells = 14;

/// p = p₀ − Σ a_d (x_d − c_d)²
struct Bowl {
  double peak = 0;
  Point centre{}, slope{};
};

/// ∫N and ∫N (x − c)² over the unit interval, N the function of the node at `x` of elements of an order.
std::array<double, 2> moments(double x, double c, int order) {
  constexpr double h = 1.0 / cells;
  const auto node = static_cast<int>(std::lround(x / h * order));
  std::array<double, 2> sums{};
  for (int e = 0; e < cells; ++e) {
    const int own = node - order * e;
    if (own < 0 || own > order)
      continue;
    for (const double side : {-1.0, 0.0, 1.0}) { // three points of Gauss, exact up to degree 5
      const double t = 0.5 + 0.5 * side * std::sqrt(0.6), weight = (side == 0 ? 8 : 5) / 18.0 * h;
      double value = 1; // Lagrange's polynomial
      for (int other = 0; other <= order; ++other)
        if (other != own)
          value *= (order * t - other) / (own - other);
      const double apart = (e + t) * h - c;
      sums[0] += weight * value;
      sums[1] += weight * value * apart * apart;
    }
  }
  return sums;
}

/// ∫pN, in the plane times the thickness.
double multiplier(const Bowl& bowl, const Point& x, int dimension, int order) {
  std::array<std::array<double, 2>, 2> along{{{1, 0}, {1, 0}}};
  for (std::size_t d = 0; d + 1 < static_cast<std::size_t>(dimension); ++d)
    along[d] = moments(x[d], bowl.centre[d], order);
  const double thickness = dimension == 2 ? 0.5 : 1; // elasticBlock's
  return thickness * (bowl.peak * along[0][0] * along[1][0] - bowl.slope[0] * along[0][1] * along[1][0] -
                      bowl.slope[1] * along[0][0] * along[1][1]);
}

struct LargestPressureTest : testing::Test {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  test::TemporaryDirectory directory{comm};

  /// A block on a rigid floor.
  [[nodiscard]] scene::Scene block(const test::Kind& kind, int order, int parts) const {
    scene::Scene scene;
    scene::Body body = test::elasticBlock(kind, "block", 0, parts, directory, *comm);
    const int dimension = mesh::dimensionOf(kind.cell);
    body.mesh.elements = {cells, dimension == 2 ? 2 : cells, dimension == 2 ? 0 : 2};
    body.mesh.order = order;
    scene.bodies = {body};
    scene::SurfaceContact contact;
    contact.name = "floor";
    contact.firstSurface = "bottom";
    contact.obstacle.normal = dimension == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1};
    scene.contacts = {contact};
    return scene;
  }

  static void press(const Bowl& bowl, const model::Decomposition& decomposition, int dimension, int order,
                    Vector& multipliers) {
    const contact::ContactLayout& layout = decomposition.contacts.front();
    for (std::size_t row = 0; row < layout.firstNodes.size(); ++row) {
      const GlobalOrdinal number = layout.firstRow + static_cast<GlobalOrdinal>(row);
      if (multipliers.getMap()->isNodeGlobalElement(number))
        multipliers.replaceGlobalValue(
            number, multiplier(bowl, decomposition.bodies.front().mesh->point(layout.firstNodes[row]),
                               dimension, order));
    }
  }
};

TEST_F(LargestPressureTest, AQuadraticPeakIsFoundExactlyAndIsASumOfMultipliers) {
  using fem::Physics;
  for (const test::Kind& kind : {test::Kind{Physics::planeStrain, mesh::CellType::quadrilateral},
                                 test::Kind{Physics::elasticity3d, mesh::CellType::hexahedron}})
    for (const int order : {1, 2})
      for (const int parts : {1, 3}) {
        SCOPED_TRACE(toString(kind.physics) + ", order " + std::to_string(order));
        const int dimension = mesh::dimensionOf(kind.cell);
        const scene::Scene scene = block(kind, order, parts);
        const auto decomposition = model::decompose(scene, comm);
        auto solution = test::solutionWith(decomposition, [](const Point&) { return Point{}; });
        for (const Point& centre : {Point{0.5, 0.5, 0}, Point{0.43, 0.57, 0}}) {
          const Bowl bowl{100, centre, {120, 80, 0}};
          press(bowl, decomposition, dimension, order, *solution.multiplier);
          const LargestPressure found =
              largestPressure({scene, decomposition, solution}, decomposition.contacts.front());
          EXPECT_NEAR(found.value, bowl.peak, 1e-7 * bowl.peak);
          EXPECT_NEAR(found.weights->dot(*solution.multiplier), found.value, 1e-9 * bowl.peak);
          EXPECT_LT(found.remainder, 1e-7 * bowl.peak);
          EXPECT_GT(found.width, 0);
        }
      }
}

TEST_F(LargestPressureTest, WithoutForceThereIsNone) {
  const scene::Scene scene = block({}, 1, 1);
  const auto decomposition = model::decompose(scene, comm);
  const auto solution = test::solutionWith(decomposition, [](const Point&) { return Point{}; });
  const LargestPressure found =
      largestPressure({scene, decomposition, solution}, decomposition.contacts.front());
  EXPECT_EQ(found.value, 0);
  EXPECT_EQ(found.weights->norm2(), 0);
}

} // namespace
} // namespace epafi::simulation
