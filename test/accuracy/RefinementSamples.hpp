#pragma once

/// Meshes of scenes that are refined, and what tests look at in them.

#include "Samples.hpp"

#include "epafi/accuracy/RefinableMeshes.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

namespace epafi::accuracy::test {

using Values = std::vector<double>;
constexpr double roundOff = 1e-12;

inline double sumOf(const Values& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

inline std::vector<std::vector<Point>> elementsOf(const mesh::Mesh& mesh) {
  std::vector<std::vector<Point>> elements(mesh.numElements());
  for (std::size_t e = 0; e < elements.size(); ++e)
    mesh.elementPoints(static_cast<GlobalOrdinal>(e), elements[e]);
  return elements;
}

inline double measureOf(const mesh::Mesh& mesh) {
  double sum = 0;
  for (const std::vector<Point>& element : elementsOf(mesh))
    sum += mesh::measureOf(mesh.cellType(), element);
  return sum;
}

inline double distance(const Point& a, const Point& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

/// Refinable meshes on all ranks.
struct RefinementTest : AccuracyTest {
  /// The bodies with elements of an order. Collective.
  [[nodiscard]] std::vector<model::BodyLayout> bodiesOf(const RefinableMeshes& meshes, int order = 1) const {
    return meshes.layout(meshes.scene(order), *comm);
  }

  /// Halvings by the centre of an element, of all bodies.
  [[nodiscard]] std::vector<Values> halvings(const RefinableMeshes& meshes,
                                             const std::function<double(const Point&)>& wanted) const {
    std::vector<Values> result;
    for (const model::BodyLayout& body : bodiesOf(meshes))
      for (Values& own = result.emplace_back(); const std::vector<Point>& element : elementsOf(*body.mesh))
        own.push_back(wanted(mesh::centreOf(element)));
    return result;
  }
};

} // namespace epafi::accuracy::test
