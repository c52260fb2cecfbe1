#include "epafi/fem/ShapeFunctions.hpp"

#include "epafi/fem/ElementMap.hpp"

#include "SampleCells.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

template <class Shape>
class ShapeFunctionsTest : public testing::Test {};

using AllShapes = testing::Types<Simplex<1>, Simplex<2>, Simplex<3>, Brick<2>, Brick<3>>;
TYPED_TEST_SUITE(ShapeFunctionsTest, AllShapes);

template <class Shape>
typename Shape::Coordinates somePoint() {
  return Shape::centre() + Shape::Coordinates::LinSpaced(0.05, 0.15);
}

TYPED_TEST(ShapeFunctionsTest, AreOneAtTheirNodeAndZeroAtTheOthers) {
  for (int node = 0; node < TypeParam::numNodes; ++node)
    EXPECT_EQ(TypeParam::values(TypeParam::corner(node)), TypeParam::Values::Unit(node));
}

TYPED_TEST(ShapeFunctionsTest, SumToOneAndTheirGradientsToZero) {
  const auto xi = somePoint<TypeParam>();
  EXPECT_NEAR(TypeParam::values(xi).sum(), 1, 1e-15);
  EXPECT_LT(TypeParam::gradients(xi).rowwise().sum().norm(), 1e-15);
}

TYPED_TEST(ShapeFunctionsTest, ReproduceTheReferenceElement) {
  Eigen::Matrix<double, TypeParam::dimension, TypeParam::numNodes> corners;
  for (int node = 0; node < TypeParam::numNodes; ++node)
    corners.col(node) = TypeParam::corner(node);
  const auto xi = somePoint<TypeParam>();
  EXPECT_LT((corners * TypeParam::values(xi) - xi).norm(), 1e-15);
  const Eigen::Matrix<double, TypeParam::dimension, TypeParam::dimension> jacobian =
      corners * TypeParam::gradients(xi).transpose();
  EXPECT_TRUE(jacobian.isIdentity(1e-15)) << jacobian;
  EXPECT_LT((corners.rowwise().mean() - TypeParam::centre()).norm(), 1e-15);
}

TYPED_TEST(ShapeFunctionsTest, GradientsAreTheDifferenceQuotients) {
  const auto xi = somePoint<TypeParam>();
  const auto gradients = TypeParam::gradients(xi);
  const double step = 1e-3; // central differences of functions linear in each ξᵢ are exact
  for (int i = 0; i < TypeParam::dimension; ++i) {
    const typename TypeParam::Coordinates along = step * TypeParam::Coordinates::Unit(i);
    const typename TypeParam::Values quotient =
        (TypeParam::values(xi + along) - TypeParam::values(xi - along)) / (2 * step);
    EXPECT_LT((gradients.row(i).transpose() - quotient).norm(), 1e-12);
  }
}

TYPED_TEST(ShapeFunctionsTest, GaussRuleIntegratesTheShapeFunctionsExactly) {
  typename TypeParam::Values integrals = TypeParam::Values::Zero();
  for (const auto& sample : gaussSamples<TypeParam>())
    integrals += TypeParam::gaussWeight * sample.values;
  const bool simplex = TypeParam::numNodes == TypeParam::dimension + 1;
  const double factorial[] = {1, 1, 2, 6};
  const double measure =
      simplex ? 1 / factorial[TypeParam::dimension] : TypeParam::numNodes; // 2^dim: as nodes
  EXPECT_LT((integrals.array() - measure / TypeParam::numNodes).abs().maxCoeff(), 1e-15);
}

TEST(BrickTest, GaussRuleIsExactForCubicFunctionsOfEachCoordinate) {
  double integral = 0; // of (ξ² + ξ³)(η² + η)(1 + ζ²) over the cube: 2/3 · 2/3 · 8/3
  for (int i = 0; i < Brick<3>::numGaussPoints; ++i) {
    const Eigen::Vector3d x = Brick<3>::gaussPoint(i);
    integral +=
        Brick<3>::gaussWeight * (x[0] * x[0] + x[0] * x[0] * x[0]) * (x[1] * x[1] + x[1]) * (1 + x[2] * x[2]);
  }
  EXPECT_NEAR(integral, 32.0 / 27, 1e-15);
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
      const double side = Shape::numNodes == Shape::dimension + 1 ? 1 : 0.5;
      const ElementMap<Shape> map(relativeCorners<Shape>(unitCell(type)), centreSample<Shape>());
      EXPECT_LT((map.jacobian() - side * ElementMap<Shape>::Jacobian::Identity()).norm(), 1e-15);
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
