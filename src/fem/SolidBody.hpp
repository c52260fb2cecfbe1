#pragma once

/// What the parts of a body's model share: the body as the scene has it, and its mesh.

#include "epafi/base/Errors.hpp"
#include "epafi/fem/StructuredMesh.hpp"
#include "epafi/scene/Body.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::fem {

/// Keeps references to a scene's body and its mesh, which must outlive it.
struct SolidBody {
  const scene::Body& body;
  const Mesh& mesh;
  /// Corners of every element, from the origin on, where the mesh is structured and all are congruent; else empty.
  std::vector<Point> shape;

  SolidBody(const scene::Body& ofScene, const Mesh& itsMesh)
      : body(ofScene), mesh(itsMesh), shape(congruentShape(itsMesh)) {}
  [[nodiscard]] bool isCongruent() const { return !shape.empty(); }
  [[nodiscard]] int components() const { return componentsOf(body.physics); }

  /// "body 'name': what".
  [[nodiscard]] InputError refusal(const std::string& what) const {
    return InputError("body '" + body.name + "': " + what);
  }
  /// Refuses the body for what it has no element or node for; of a piece it is wrong only if all pieces lack it, and is noted.
  void lack(const std::string& what) const;
  /// What was noted, whole sentences.
  [[nodiscard]] const std::vector<std::string>& lacking() const { return *lacking_; }
  /// \throws InputError if the mesh has no such surface. \param user  who asks, such as "support 'floor'"
  [[nodiscard]] Surface surfaceOf(const std::string& user, const std::string& surface) const;
  /// Ascending. \throws InputError if the mesh has no such group.
  [[nodiscard]] std::vector<GlobalOrdinal> groupOf(const std::string& user, const std::string& group) const;
  /// Corners of an element up to a shift: what integrals need, and equal to the last bit where elements are congruent.
  void cornersOf(GlobalOrdinal element, std::vector<Point>& points) const;

private:
  std::shared_ptr<std::vector<std::string>> lacking_ = std::make_shared<std::vector<std::string>>();
};

} // namespace epafi::fem
