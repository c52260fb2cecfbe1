#include "epafi/fem/FacetLoads.hpp"

#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

#include <array>
#include <cassert>

namespace epafi::fem {
namespace {

using scene::Physics;

[[maybe_unused]] bool fits(CellType facet, Physics physics) {
  return dimensionOf(facet) + 1 == scene::dimensionOf(physics);
}

} // namespace

void tractionLoad(CellType facet, std::span<const Point> points, Physics physics,
                  const scene::Material& material, const scene::Vector3& traction, Eigen::VectorXd& load) {
  assert(fits(facet, physics));
  std::array<double, mostFacetNodes> shares{};
  nodalShares(facet, points, std::span(shares).first(points.size()));
  const auto numNodes = static_cast<int>(points.size());
  const int components = componentsOf(physics);
  const double thickness = thicknessOf(physics, material);
  load.resize(static_cast<Eigen::Index>(numNodes) * components);
  for (int a = 0; a < numNodes; ++a)
    for (int i = 0; i < components; ++i)
      load[a * components + i] =
          thickness * shares[static_cast<std::size_t>(a)] * traction[static_cast<std::size_t>(i)];
}

void pressureLoad(CellType facet, std::span<const Point> points, Physics physics,
                  const scene::Material& material, double pressure, Eigen::VectorXd& load) {
  assert(fits(facet, physics) && physics != Physics::membrane);
  withFacetShape(facet, [&](auto shape) {
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
