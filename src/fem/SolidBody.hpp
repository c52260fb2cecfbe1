#pragma once

/// What the parts of a solid's model share: the body as the scene has it, and its mesh.

#include "epafi/base/Errors.hpp"
#include "epafi/fem/Mesh.hpp"
#include "epafi/scene/Solid.hpp"

#include <string>
#include <vector>

namespace epafi::fem {

/// Keeps references to a scene's solid and its mesh, which must outlive it.
struct SolidBody {
  std::string name;
  const scene::Solid& solid;
  const Mesh& mesh;
  /// Corners of every element, from the origin on, where the mesh is structured and all are congruent; else empty.
  std::vector<Point> shape;

  SolidBody(std::string bodyName, const scene::Solid& bodySolid, const Mesh& bodyMesh);
  [[nodiscard]] bool isCongruent() const { return !shape.empty(); }
  [[nodiscard]] int components() const { return componentsOf(solid.physics); }

  /// "body 'name': what".
  [[nodiscard]] InputError refusal(const std::string& what) const;
  /// \throws InputError if the mesh has no such surface. \param user  who asks, such as "support 'floor'"
  [[nodiscard]] Surface surfaceOf(const std::string& user, const std::string& surface) const;
  /// Ascending. \throws InputError if the mesh has no such group.
  [[nodiscard]] std::vector<GlobalOrdinal> groupOf(const std::string& user, const std::string& group) const;
  /// Corners of an element; `points` is overwritten.
  void pointsOf(GlobalOrdinal element, std::vector<Point>& points) const;
  /// The same up to a shift: what integrals need, and equal to the last bit where elements are congruent.
  void cornersOf(GlobalOrdinal element, std::vector<Point>& points) const;
};

/// Corners of an element, from the origin on, where the mesh is structured and all are congruent; else empty.
std::vector<Point> congruentCorners(const Mesh& mesh);

/// "(1, 2, 3)", for errors.
std::string text(const Point& point);

} // namespace epafi::fem
