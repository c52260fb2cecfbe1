#include "epafi/mesh/ShapeFunctions.hpp"

#include "epafi/mesh/ElementMap.hpp"

#include "support/SampleCells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace epafi::mesh {
namespace {

using namespace test;

/// action(shape) for all shapes, the facets' included.
template <class Action>
void forAllShapes(const Action& action) {
  for (const CellType type : allCellTypes) {
    SCOPED_TRACE(toString(type));
    withShape(type, action);
    for (const Facet& facet : {facetsOf(type).front(), facetsOf(type).back()})
      withFacetShape(facet.type, action);
  }
}

template <int dim>
Coordinates<dim> somePoint(const Shape<dim>& shape) {
  return shape.centre() + Coordinates<dim>::LinSpaced(0.05, 0.15);
}

TEST(ShapeFunctionsTest, AreOneAtTheirNodeAndZeroAtTheOthers) {
  forAllShapes([](const auto& shape) {
    for (int node = 0; node < shape.numNodes; ++node)
      EXPECT_EQ(shape.values(shape.node(node)), NodalValues::Unit(shape.numNodes, node));
  });
}

TEST(ShapeFunctionsTest, SumToOneAndTheirGradientsToZero) {
  forAllShapes([](const auto& shape) {
    const auto xi = somePoint(shape);
    EXPECT_NEAR(shape.values(xi).sum(), 1, 1e-15);
    EXPECT_LT(shape.gradients(xi).rowwise().sum().norm(), 1e-14);
  });
}

TEST(ShapeFunctionsTest, ReproduceTheReferenceElement) {
  forAllShapes([]<int dim>(const Shape<dim>& shape) {
    NodalColumns<dim> corners(dim, shape.numNodes);
    for (int node = 0; node < shape.numNodes; ++node)
      corners.col(node) = shape.node(node);
    const auto sample = shape.sampleAt(somePoint(shape));
    EXPECT_LT((corners * sample.values - sample.xi).norm(), 1e-14);
    const auto jacobian = derivatives(corners, sample);
    EXPECT_TRUE(jacobian.isIdentity(1e-14)) << jacobian;
    if (numCornersOf(shape.type) == 5) // whose nodes are nearer to the base on average, or to the top
      return;
    EXPECT_LT((corners.rowwise().mean() - shape.centre()).norm(), 1e-15);
  });
}

TEST(ShapeFunctionsTest, GradientsAreTheDifferenceQuotients) {
  forAllShapes([]<int dim>(const Shape<dim>& shape) {
    const auto xi = somePoint(shape);
    const auto gradients = shape.gradients(xi);
    const double step = 1e-3; // central differences of functions quadratic in each ξᵢ are exact
    const double tolerance = numCornersOf(shape.type) == 5 ? 1e-5 : 1e-12; // rational ones'
    for (int i = 0; i < dim; ++i) {
      const Coordinates<dim> along = step * Coordinates<dim>::Unit(i);
      const NodalValues quotient = (shape.values(xi + along) - shape.values(xi - along)) / (2 * step);
      EXPECT_LT((gradients.row(i).transpose() - quotient).norm(), tolerance);
    }
  });
}

double factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

/// ∫ξ^k over [−1, 1].
double alongEdge(int k) {
  return k % 2 == 0 ? 2.0 / (k + 1) : 0;
}

/// ∫Πξᵢ^kᵢ over a prism or pyramid.
double integralOfOther(bool isPyramid, const std::array<int, 3>& k) {
  const int level = k[0] + k[1] + 2;
  return isPyramid ? alongEdge(k[0]) * alongEdge(k[1]) * factorial(k[2]) * factorial(level) /
                         factorial(level + k[2] + 1)
                   : factorial(k[0]) * factorial(k[1]) / factorial(level) * alongEdge(k[2]);
}

/// Σ w Πξᵢ^kᵢ by a rule, less ∫: Πkᵢ!/(dim + Σkᵢ)! on simplices, products of 2/(kᵢ + 1) or 0 on bricks.
template <int dim>
double errorOf(const Shape<dim>& shape, const std::vector<ShapeSample<dim>>& rule,
               const std::array<int, 3>& powers) {
  double sum = 0, expected = 1;
  for (const auto& point : rule) {
    double value = point.weight;
    for (int i = 0; i < dim; ++i)
      value *= std::pow(point.xi[i], powers[i]);
    sum += value;
  }
  int total = dim;
  for (std::size_t i = 0; i < dim; ++i) {
    total += powers[i];
    expected *= shape.isSimplex ? factorial(powers[i]) : powers[i] % 2 == 0 ? 2.0 / (powers[i] + 1) : 0;
  }
  if (!shape.isSimplex && !shape.isBrick)
    return sum - integralOfOther(numCornersOf(shape.type) == 5, powers);
  return sum - (shape.isSimplex ? expected / factorial(total) : expected);
}

/// Prisms: of the triangle's degree there, and of the edge's along it. Pyramids: of all coordinates together.
TEST(ShapeFunctionsTest, RulesOfPrismsAndPyramidsAreExactForPolynomialsOfTheirDegree) {
  for (const CellType type : {CellType::prism, CellType::prism15, CellType::pyramid, CellType::pyramid13}) {
    SCOPED_TRACE(toString(type));
    const Shape<3>& shape = referenceShape<3>(type);
    const bool isPyramid = numCornersOf(type) == 5;
    const int along = 2 * shape.order + 1;
    for (int code = 0; code < power(6, 3); ++code) {
      const std::array<int, 3> powers{code % 6, code / 6 % 6, code / 36};
      const int level = powers[0] + powers[1];
      const auto isWithin = [&](int degree) {
        return isPyramid ? level + powers[2] <= along : level <= degree && powers[2] <= along;
      };
      if (isWithin(shape.order)) {
        EXPECT_NEAR(errorOf(shape, shape.reducedSamples(), powers), 0, 5e-15);
      }
      if (isWithin(2 * shape.order)) {
        EXPECT_NEAR(errorOf(shape, shape.gaussSamples(), powers), 0, 5e-15);
      }
    }
    for (const auto& point : shape.fineSamples())
      EXPECT_GT(point.weight, 0);
  }
}

/// Also of pyramids, whose own are rational.
TEST(ShapeFunctionsTest, QuadraticFunctionsAreReproducedByOrderTwo) {
  for (const CellType type : {CellType::prism15, CellType::pyramid13}) {
    SCOPED_TRACE(toString(type));
    const Shape<3>& shape = referenceShape<3>(type);
    const auto function = [](const auto& x) {
      return 1 + 2 * x[0] - x[1] + x[2] + x[0] * x[1] + 3 * x[0] * x[0] - x[1] * x[2] + x[2] * x[2] -
             2 * x[2] * x[0] - x[1] * x[1];
    };
    NodalValues nodal(shape.numNodes);
    for (int a = 0; a < shape.numNodes; ++a)
      nodal[a] = function(shape.node(a));
    const Coordinates<3> xi = somePoint(shape);
    EXPECT_NEAR(nodal.dot(shape.values(xi)), function(xi), 1e-14);
  }
}

/// What a cell's functions are on a facet is all that its neighbours share with it.
TEST(ShapeFunctionsTest, AreThoseOfTheFacetOnEachFacet) {
  for (const CellType type : allCellTypes) {
    SCOPED_TRACE(toString(type));
    withShape(type, [&]<int dim>(const Shape<dim>& shape) {
      for (const Facet& facet : facetsOf(type)) {
        const Shape<dim - 1>& own = referenceShape<dim - 1>(facet.type);
        const NodalValues there = own.values(somePoint(own));
        Coordinates<dim> xi = Coordinates<dim>::Zero();
        NodalValues expected = NodalValues::Zero(shape.numNodes);
        for (std::size_t a = 0; a < facet.size(); ++a) {
          xi += there[static_cast<Eigen::Index>(a)] * shape.node(facet[a]);
          expected[facet[a]] = there[static_cast<Eigen::Index>(a)];
        }
        EXPECT_LT((shape.values(xi) - expected).norm(), 1e-14);
      }
    });
  }
}

TEST(ShapeFunctionsTest, RulesAreExactForPolynomialsOfTheirDegree) {
  forAllShapes([]<int dim>(const Shape<dim>& shape) {
    if (!shape.isSimplex && !shape.isBrick)
      return;
    const int low = !shape.isSimplex ? 2 * shape.order + 1 : shape.order == 1 ? 1 : dim == 1 ? 5 : dim;
    const int high = !shape.isSimplex ? low : shape.order == 1 ? 1 : dim == 2 ? 4 : 5;
    for (int code = 0; code < power(6, dim); ++code) {
      const std::array<int, 3> powers{code % 6, code / 6 % 6, code / 36};
      const int degree = shape.isSimplex ? powers[0] + powers[1] + powers[2]
                                         : *std::max_element(powers.begin(), powers.end());
      if (degree <= low) {
        EXPECT_NEAR(errorOf(shape, shape.gaussSamples(), powers), 0, 5e-15);
      }
      if (degree <= high) {
        EXPECT_NEAR(errorOf(shape, shape.fineSamples(), powers), 0, 5e-15);
      }
    }
    for (const auto& point : shape.fineSamples())
      EXPECT_GT(point.weight, 0);
  });
}

/// Order by order, of bricks: two points along each axis are exact for cubics.
TEST(ShapeFunctionsTest, ReducedRulesOfBricksAreExactForCubics) {
  for (const CellType type : {CellType::quadrilateral8, CellType::hexahedron20, CellType::hexahedron27})
    withShape(type, []<int dim>(const Shape<dim>& shape) {
      EXPECT_EQ(std::ssize(shape.reducedSamples()), 1 << dim);
      for (int code = 0; code < power(4, dim); ++code)
        EXPECT_NEAR(errorOf(shape, shape.reducedSamples(), {code % 4, code / 4 % 4, code / 16}), 0, 5e-15);
    });
}

/// Of ξ²η and its like, but of no more.
TEST(ShapeFunctionsTest, SerendipityFunctionsReproduceQuadraticFunctions) {
  for (const CellType type : {CellType::quadrilateral8, CellType::hexahedron20})
    withShape(type, []<int dim>(const Shape<dim>& shape) {
      const auto function = [](const auto& x) {
        return 1 + 2 * x[0] - x[1] + x[0] * x[1] + 3 * x[0] * x[0] - x[1] * x[1] + 0.5 * x[0] * x[0] * x[1] +
               (dim == 3 ? x[dim - 1] * (x[0] * x[1] + x[dim - 1] + x[1] * x[1] * x[0]) : 0.0);
      };
      NodalValues nodal(shape.numNodes);
      for (int a = 0; a < shape.numNodes; ++a)
        nodal[a] = function(shape.node(a));
      const Coordinates<dim> xi = somePoint(shape);
      EXPECT_NEAR(nodal.dot(shape.values(xi)), function(xi), 1e-14);
    });
}

TEST(ShapeOfCellTest, HasTheNodesAndTheDimensionOfTheCellAndItsFacets) {
  for (const CellType type : allCellTypes) {
    SCOPED_TRACE(toString(type));
    EXPECT_EQ(withShape(type, []<int dim>(const Shape<dim>& shape) { return 100 * dim + shape.numNodes; }),
              100 * dimensionOf(type) + numNodesOf(type));
    EXPECT_EQ(withFacetShape(facetTypeOf(type),
                             []<int dim>(const Shape<dim>& shape) { return 100 * dim + shape.numNodes; }),
              100 * (dimensionOf(type) - 1) + nodesPerFacet(type));
  }
}

/// Corners of the reference element look as in Cell.hpp: Jacobian of the unit cell is a positive multiple of
/// the identity.
TEST(ElementMapTest, MapsTheReferenceElementOntoTheUnitCell) {
  for (const CellType type : allCellTypes)
    withShape(type, [&]<int dim>(const Shape<dim>& shape) {
      SCOPED_TRACE(toString(type));
      Coordinates<dim> sides = Coordinates<dim>::Constant(shape.isSimplex ? 1 : 0.5);
      if (numCornersOf(type) == 5) // of height 1
        sides[dim - 1] = 1;
      else if (numCornersOf(type) == 6)
        sides.template head<2>().setOnes();
      const ElementMap map(relativeCorners<dim>(unitCell(type)), shape.centreSample());
      EXPECT_LT((map.jacobian() - typename ElementMap<dim>::Jacobian(sides.asDiagonal())).norm(), 1e-14);
    });
}

TEST(ElementMapTest, GradientsOfLinearFunctionsAreExactOnDistortedElements) {
  for (const CellType type : allCellTypes)
    withShape(type, [&]<int dim>(const Shape<dim>& shape) {
      SCOPED_TRACE(toString(type));
      const auto points = distortedCell(type, 1);
      const Eigen::Vector3d gradient(3, -1, 2);
      NodalValues nodal(shape.numNodes);
      for (int a = 0; a < shape.numNodes; ++a)
        nodal[a] = 7 + gradient.dot(vectorOf(points[a]));
      const auto corners = relativeCorners<dim>(points);
      for (const auto& sample : shape.gaussSamples()) {
        const Coordinates<dim> found = ElementMap(corners, sample).gradients(sample) * nodal;
        EXPECT_LT((found - gradient.head<dim>()).norm(), 1e-13);
      }
    });
}

} // namespace
} // namespace epafi::mesh
