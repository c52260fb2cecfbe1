#pragma once

/// What the parts of a body's model share: the solid, and its mesh.

#include "epafi/base/Errors.hpp"
#include "epafi/fem/Solid.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace epafi::fem {

/// Corners of every element up to a shift where those of a body's elements all have the same stiffness: where
/// they are congruent, and neither r nor a factor is part of it; else empty.
inline std::vector<Point> sharedShape(const Solid& solid, const mesh::Mesh& mesh) {
  const bool isOne = solid.physics != Physics::axisymmetric && solid.stiffnessFactors.empty();
  return isOne ? mesh::congruentShape(mesh) : std::vector<Point>();
}

/// Keeps references to a solid and its mesh, which must outlive it.
struct SolidBody {
  const Solid& solid;
  const mesh::Mesh& mesh;
  /// Corners of every element, from the origin on, where they have one stiffness by region; else empty.
  std::vector<Point> shape;

  SolidBody(const Solid& itsSolid, const mesh::Mesh& itsMesh)
      : solid(itsSolid), mesh(itsMesh), shape(sharedShape(itsSolid, itsMesh)) {}
  [[nodiscard]] bool isCongruent() const { return !shape.empty(); }
  [[nodiscard]] int components() const { return componentsOf(solid.physics); }

  /// Lowest and highest coordinates of the whole body.
  [[nodiscard]] std::array<Point, 2> box() const;
  /// Nodes of a solid of revolution that are this near to its axis lie on it.
  [[nodiscard]] double axisTolerance() const;
  /// "body 'name': what".
  [[nodiscard]] InputError refusal(const std::string& what) const {
    return InputError("body '" + solid.name + "': " + what);
  }
  /// Something that the solid names, and its mesh should have.
  struct Need {
    bool isMet;
    std::string refusal; ///< a whole sentence
  };
  /// Refuses the body for what it has no element or node for; of a piece it is noted, since another piece may
  /// have it.
  void require(bool isMet, const std::string& why) const;
  /// What was noted; the same needs in the same order of all pieces.
  [[nodiscard]] const std::vector<Need>& needs() const { return *needs_; }
  /// \throws InputError if the mesh has no such surface. \param user  who asks, such as "support 'floor'"
  [[nodiscard]] mesh::Surface surfaceOf(const std::string& user, const std::string& surface) const;
  /// Nodes of a surface, or of a set of nodes where no surface has the name, ascending.
  /// \throws InputError if the mesh has neither.
  [[nodiscard]] std::vector<GlobalOrdinal> nodesOf(const std::string& user, const std::string& name) const;
  /// Ascending. \throws InputError if the mesh has no such group.
  [[nodiscard]] std::vector<GlobalOrdinal> groupOf(const std::string& user, const std::string& group) const;
  /// Corners of an element up to a shift: what integrals need, and equal to the last bit where elements are
  /// congruent.
  void cornersOf(GlobalOrdinal element, std::vector<Point>& points) const;

private:
  std::shared_ptr<std::vector<Need>> needs_ = std::make_shared<std::vector<Need>>();
};

} // namespace epafi::fem
