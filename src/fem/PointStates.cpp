#include "epafi/fem/PointStates.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace epafi::fem {
namespace {

using Samples = mesh::Shape<3>::Samples;

/// By what points are sorted: layer, then row and column, or the place of the corner next to it.
std::array<double, 3> sortingKey(const mesh::Shape<3>& shape, const mesh::Coordinates<3>& xi) {
  constexpr double sameLayer = 1e-6;
  const auto rounded = [](double value) { return std::round(value / sameLayer); };
  if (shape.isBrick)
    return {rounded(xi[2]), rounded(xi[1]), rounded(xi[0])};
  const int numCorners = numCornersOf(shape.type), inLayer = shape.isSimplex ? numCorners : 3;
  int nearest = 0;
  for (int corner = 1; corner < inLayer; ++corner) {
    const auto distance = [&](int node) {
      const mesh::Coordinates<3> apart = shape.node(node) - xi;
      return shape.isSimplex ? apart.norm() : apart.head<2>().norm();
    };
    if (distance(corner) < distance(nearest) - sameLayer)
      nearest = corner;
  }
  return {shape.isSimplex ? 0 : rounded(xi[2]), static_cast<double>(nearest), 0};
}

/// Of tetrahedra of order 2 the four points of a rule of degree 2, as others integrate them.
Samples tetrahedronSamples(const mesh::Shape<3>& shape) {
  constexpr double far = 0.13819660112501051, near = 1 - 3 * far;
  Samples samples;
  for (int corner = 0; corner < 4; ++corner) {
    mesh::Coordinates<3> xi = mesh::Coordinates<3>::Constant(far);
    if (corner > 0)
      xi[corner - 1] = near;
    samples.push_back(shape.sampleAt(xi));
  }
  return samples;
}

std::vector<std::size_t> inOrder(const mesh::Shape<3>& shape, const Samples& samples) {
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sortingKey(shape, samples[a].xi) < sortingKey(shape, samples[b].xi);
  });
  return order;
}

SymmetricTensor symmetricPart(const Eigen::Matrix3d& gradient) {
  SymmetricTensor part{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j)
      part[placeInTensor[i][j]] = 0.5 * (gradient(i, j) + gradient(j, i));
  return part;
}

double interpolated(std::span<const double> nodal, const mesh::NodalValues& values, double otherwise) {
  return nodal.empty() ? otherwise
                       : values.dot(Eigen::Map<const Eigen::VectorXd>(nodal.data(), values.size()));
}

} // namespace

void pointStates(mesh::CellType type, std::span<const Point> points, const Material& material,
                 std::span<const double> displacements, Integration integration, const NodalState& state,
                 std::vector<PointState>& states) {
  const mesh::Shape<3>& shape = mesh::referenceShape<3>(type);
  const Samples samples = shape.isSimplex && shape.order == 2   ? tetrahedronSamples(shape)
                          : integration == Integration::reduced ? shape.reducedSamples()
                                                                : shape.gaussSamples();
  const auto corners = mesh::relativeCorners<3>(points);
  const Eigen::Map<const Eigen::Matrix3Xd> nodal(displacements.data(), 3, std::ssize(points));
  states.clear();
  for (const std::size_t place : inOrder(shape, samples)) {
    const mesh::ShapeSample<3>& sample = samples[place];
    const Eigen::Matrix3d gradient = nodal * mesh::ElementMap(corners, sample).gradients(sample).transpose();
    const Eigen::Matrix3d elastic =
        gradient - thermalStrain(Physics::elasticity3d, material,
                                 interpolated(state.temperatureChange, sample.values, 0));
    SymmetricTensor stress = stressOf(elastic, Physics::elasticity3d, material);
    for (double& component : stress)
      component *= interpolated(state.stiffnessFactor, sample.values, 1);
    states.push_back({stress, symmetricPart(gradient), symmetricPart(elastic)});
  }
}

} // namespace epafi::fem
