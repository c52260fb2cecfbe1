#pragma once

/// How long the edges of a mesh are to be, all over a body.

#include "epafi/mesh/BoxTree.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <cstddef>
#include <vector>

namespace epafi::mesh {

/// Sizes at the corners of triangles (in the plane) or tetrahedra, linear between them.
struct MeshSizes {
  int dimension = 2;
  std::vector<Point> corners; ///< dimension + 1 of each simplex
  std::vector<double> sizes;  ///< at each of them, > 0
};

/// Finds the simplex that a point lies in, of those that overlap the one with the smallest size, in a tree of
/// their boxes.
class SizeField {
public:
  /// Precondition: at least one simplex. Keeps the sizes.
  explicit SizeField(MeshSizes sizes);

  /// Beyond all simplices the size on the nearest.
  [[nodiscard]] double at(const Point& point) const;

private:
  /// \param[out] outside  how far, about; 0 inside
  [[nodiscard]] double sizeIn(std::size_t simplex, const Point& point, double& outside) const;

  MeshSizes sizes_;
  BoxTree boxes_;
};

} // namespace epafi::mesh
