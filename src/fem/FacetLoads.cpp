#include "epafi/fem/FacetLoads.hpp"

#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

#include <cassert>

namespace epafi::fem {
namespace {

using scene::Physics;

[[maybe_unused]] bool fits(std::span<const Point> points, Physics physics) {
  return (points.size() == 2) == (physics != Physics::elasticity3d);
}

} // namespace

void tractionLoad(std::span<const Point> points, Physics physics, const scene::Material& material,
                  const scene::Vector3& traction, Eigen::VectorXd& load) {
  assert(fits(points, physics));
  withFacetShape(points.size(), [&](auto shape) {
    using Shape = decltype(shape);
    const auto corners = relativeCorners<Shape, Shape::dimension + 1>(points);
    typename Shape::Values integrals = Shape::Values::Zero(); // ∫N_a
    for (const auto& sample : gaussSamples<Shape>())
      integrals += (Shape::gaussWeight * facetNormal<Shape>(corners, sample).norm()) * sample.values;
    const int components = physics == Physics::membrane ? 1 : Shape::dimension + 1;
    const double thickness = thicknessOf(physics, material);
    load.resize(Shape::numNodes * components);
    for (int a = 0; a < Shape::numNodes; ++a)
      for (int i = 0; i < components; ++i)
        load[a * components + i] = thickness * integrals[a] * traction[static_cast<std::size_t>(i)];
  });
}

void pressureLoad(std::span<const Point> points, Physics physics, const scene::Material& material,
                  double pressure, Eigen::VectorXd& load) {
  assert(fits(points, physics) && physics != Physics::membrane);
  withFacetShape(points.size(), [&](auto shape) {
    using Shape = decltype(shape);
    constexpr int components = Shape::dimension + 1;
    const auto corners = relativeCorners<Shape, components>(points);
    Eigen::Matrix<double, components, Shape::numNodes> forces;
    forces.setZero();
    const double factor = -pressure * thicknessOf(physics, material) * Shape::gaussWeight;
    for (const auto& sample : gaussSamples<Shape>())
      forces += (factor * facetNormal<Shape>(corners, sample)) * sample.values.transpose();
    load = forces.reshaped();
  });
}

} // namespace epafi::fem
