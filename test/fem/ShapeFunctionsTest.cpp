#include "epafi/fem/ShapeFunctions.hpp"

#include "epafi/fem/ElementMap.hpp"

#include "SampleCells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace epafi::fem {
namespace {

template <class Shape>
class ShapeFunctionsTest : public testing::Test {};

using AllShapes = testing::Types<Simplex<1>, Simplex<2>, Simplex<3>, Brick<2>, Brick<3>, Simplex<1, 2>,
                                 Simplex<2, 2>, Simplex<3, 2>, Brick<2, 2>, Brick<3, 2>>;
TYPED_TEST_SUITE(ShapeFunctionsTest, AllShapes);

template <class Shape>
typename Shape::Coordinates somePoint() {
  return Shape::centre() + Shape::Coordinates::LinSpaced(0.05, 0.15);
}

TYPED_TEST(ShapeFunctionsTest, AreOneAtTheirNodeAndZeroAtTheOthers) {
  for (int node = 0; node < TypeParam::numNodes; ++node)
    EXPECT_EQ(TypeParam::values(TypeParam::node(node)), TypeParam::Values::Unit(node));
}

TYPED_TEST(ShapeFunctionsTest, SumToOneAndTheirGradientsToZero) {
  const auto xi = somePoint<TypeParam>();
  EXPECT_NEAR(TypeParam::values(xi).sum(), 1, 1e-15);
  EXPECT_LT(TypeParam::gradients(xi).rowwise().sum().norm(), 1e-14);
}

TYPED_TEST(ShapeFunctionsTest, ReproduceTheReferenceElement) {
  Eigen::Matrix<double, TypeParam::dimension, TypeParam::numNodes> corners;
  for (int node = 0; node < TypeParam::numNodes; ++node)
    corners.col(node) = TypeParam::node(node);
  const auto xi = somePoint<TypeParam>();
  EXPECT_LT((corners * TypeParam::values(xi) - xi).norm(), 1e-14);
  const Eigen::Matrix<double, TypeParam::dimension, TypeParam::dimension> jacobian =
      corners * TypeParam::gradients(xi).transpose();
  EXPECT_TRUE(jacobian.isIdentity(1e-14)) << jacobian;
  EXPECT_LT((corners.rowwise().mean() - TypeParam::centre()).norm(), 1e-15);
}

TYPED_TEST(ShapeFunctionsTest, GradientsAreTheDifferenceQuotients) {
  const auto xi = somePoint<TypeParam>();
  const auto gradients = TypeParam::gradients(xi);
  const double step = 1e-3; // central differences of functions quadratic in each ξᵢ are exact
  for (int i = 0; i < TypeParam::dimension; ++i) {
    const typename TypeParam::Coordinates along = step * TypeParam::Coordinates::Unit(i);
    const typename TypeParam::Values quotient =
        (TypeParam::values(xi + along) - TypeParam::values(xi - along)) / (2 * step);
    EXPECT_LT((gradients.row(i).transpose() - quotient).norm(), 1e-12);
  }
}

double factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

/// Σ w Πξᵢ^kᵢ by a rule, less ∫: Πkᵢ!/(dim + Σkᵢ)! on simplices, products of 2/(kᵢ + 1) or 0 on bricks.
template <class Shape, class Samples>
double errorOf(const Samples& rule, const std::array<int, 3>& powers) {
  double sum = 0, expected = 1;
  for (const auto& point : rule) {
    double value = point.weight;
    for (int i = 0; i < Shape::dimension; ++i)
      value *= std::pow(point.xi[i], powers[static_cast<std::size_t>(i)]);
    sum += value;
  }
  int total = Shape::dimension;
  for (std::size_t i = 0; i < Shape::dimension; ++i) {
    total += powers[i];
    expected *= Shape::isSimplex ? factorial(powers[i]) : powers[i] % 2 == 0 ? 2.0 / (powers[i] + 1) : 0;
  }
  return sum - (Shape::isSimplex ? expected / factorial(total) : expected);
}

TYPED_TEST(ShapeFunctionsTest, RulesAreExactForPolynomialsOfTheirDegree) {
  constexpr int dim = TypeParam::dimension, order = TypeParam::order;
  const int low = !TypeParam::isSimplex ? 2 * order + 1 : order == 1 ? 1 : dim == 1 ? 5 : dim;
  const int high = !TypeParam::isSimplex ? low : order == 1 ? 1 : dim == 2 ? 4 : 5;
  for (int code = 0; code < power(6, dim); ++code) {
    const std::array<int, 3> powers{code % 6, code / 6 % 6, code / 36};
    const int degree = TypeParam::isSimplex ? powers[0] + powers[1] + powers[2]
                                            : *std::max_element(powers.begin(), powers.end());
    if (degree <= low) {
      EXPECT_NEAR(errorOf<TypeParam>(TypeParam::gaussPoints(), powers), 0, 5e-15);
    }
    if (degree <= high) {
      EXPECT_NEAR(errorOf<TypeParam>(TypeParam::finePoints(), powers), 0, 5e-15);
    }
  }
  for (const auto& point : TypeParam::finePoints())
    EXPECT_GT(point.weight, 0);
}

TEST(ShapeOfCellTest, HasTheNodesAndTheDimensionOfTheCellAndItsFacets) {
  for (const CellType type : allCellTypes) {
    SCOPED_TRACE(toString(type));
    EXPECT_EQ(withShape(type, [](auto shape) { return decltype(shape)::numNodes; }), numNodesOf(type));
    EXPECT_EQ(withShape(type, [](auto shape) { return decltype(shape)::dimension; }), dimensionOf(type));
    EXPECT_EQ(withFacetShape(facetTypeOf(type), [](auto shape) { return decltype(shape)::numNodes; }),
              nodesPerFacet(type));
    EXPECT_EQ(withFacetShape(facetTypeOf(type), [](auto shape) { return decltype(shape)::dimension; }),
              dimensionOf(type) - 1);
  }
}

/// Corners of the reference element look as in Cell.hpp: Jacobian of the unit cell is a positive multiple of the identity.
TEST(ElementMapTest, MapsTheReferenceElementOntoTheUnitCell) {
  for (const CellType type : allCellTypes)
    withShape(type, [&](auto shape) {
      SCOPED_TRACE(toString(type));
      using Shape = decltype(shape);
      const double side = Shape::isSimplex ? 1 : 0.5;
      const ElementMap<Shape> map(relativeCorners<Shape>(unitCell(type)), centreSample<Shape>());
      EXPECT_LT((map.jacobian() - side * ElementMap<Shape>::Jacobian::Identity()).norm(), 1e-14);
    });
}

TEST(ElementMapTest, GradientsOfLinearFunctionsAreExactOnDistortedElements) {
  for (const CellType type : allCellTypes)
    withShape(type, [&](auto shape) {
      SCOPED_TRACE(toString(type));
      using Shape = decltype(shape);
      const auto points = distortedCell(type, 1);
      const Eigen::Vector3d gradient(3, -1, 2);
      typename Shape::Values nodal;
      for (int a = 0; a < Shape::numNodes; ++a)
        nodal[a] = 7 + gradient.dot(vectorOf(points[static_cast<std::size_t>(a)]));
      const auto corners = relativeCorners<Shape>(points);
      for (const auto& sample : gaussSamples<Shape>()) {
        const typename Shape::Coordinates found =
            ElementMap<Shape>(corners, sample).gradients(sample) * nodal;
        EXPECT_LT((found - gradient.head<Shape::dimension>()).norm(), 1e-13);
      }
    });
}

} // namespace
} // namespace epafi::fem
