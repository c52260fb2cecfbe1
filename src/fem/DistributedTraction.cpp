#include "epafi/fem/DistributedTraction.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <vector>

namespace epafi::fem {

using Eigen::Vector3d;

DistributedTraction::DistributedTraction(const SolidBody& body, const mesh::Surface& surface,
                                         const SolidLoad& load, const MaterialAt& materialAt)
    : physics_(body.solid.physics), force_(load.value.data()) {
  std::vector<Point> points;
  const auto visit = [&](const auto& action) {
    for (std::size_t f = 0; f < surface.numFacets(); ++f) {
      body.mesh.pointsAt(surface.facet(f), points);
      for (const FacetSample& sample : facetSamples(surface.typeOf(f), points, physics_, materialAt(f)))
        action(sample.weight, sample.place);
    }
  };
  double area = 0;
  Vector3d sum(0, 0, 0), origin(0, 0, 0);
  visit([&](double weight, const Vector3d& place) {
    if (area == 0)
      origin = place; // sums of distances from it are more exact than those from the axes
    area += weight;
    sum += weight * (place - origin);
  });
  centre_ = origin + sum / area;
  const Vector3d way = load.atCentre ? Vector3d::Zero() : Vector3d(Vector3d(load.point.data()) - centre_);
  const Vector3d moment = Vector3d(load.moment.data()) + way.cross(force_);
  force_ /= area;
  if (physics_ == Physics::axisymmetric)
    return;                                          // forces along the axis are even
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero(); // M = ∫ r × (θ × r)
  visit([&](double weight, const Vector3d& place) {
    const Vector3d r = place - centre_;
    inertia += weight * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  });
  if (body.components() == 2)
    turn_.z() = moment.z() / inertia(2, 2);
  else
    turn_ = inertia.inverse() * moment;
}

void DistributedTraction::of(mesh::CellType facet, std::span<const Point> points, const Material& material,
                             Eigen::VectorXd& load) const {
  const Eigen::Index components = componentsOf(physics_);
  load.setZero(components * std::ssize(points));
  for (const FacetSample& sample : facetSamples(facet, points, physics_, material)) {
    const Vector3d traction = sample.weight * (force_ + turn_.cross(sample.place - centre_));
    for (Eigen::Index a = 0; a < std::ssize(points); ++a)
      load.segment(a * components, components) += sample.values[a] * traction.head(components);
  }
}

} // namespace epafi::fem
