#pragma once

/// The meshes of a scene as they are refined where it matters: triangles and tetrahedra on all ranks alike.
///
/// What is on a rectangle or box, or comes from a mesh file, is bisected; a geometry (.geo) is meshed anew by
/// Gmsh, with the sizes that are wanted, so that new nodes lie on it; unless it says itself how many elements
/// lie along its edges, in rows of quadrilaterals say, or its shape is that of a mesh (STL): then it is
/// bisected too, on the arcs of its first mesh. Surfaces and groups are those of the scene.

#include "epafi/base/Types.hpp"
#include "epafi/mesh/SimplexMesh.hpp"
#include "epafi/model/BodyLayout.hpp"
#include "epafi/scene/Scene.hpp"

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace epafi::accuracy {

class RefinableMeshes {
public:
  /// The first meshes: see firstGrid() for bodies without a mesh file; of the others the scene's own.
  /// Collective. \throws InputError, the same on all ranks, if a file cannot be read or meshed.
  RefinableMeshes(const scene::Scene& scene, const Comm& comm);

  /// The scene with bodies that are cut into as many parts as such meshes want, and whose elements have an
  /// order.
  [[nodiscard]] scene::Scene scene(int order) const;
  /// Its bodies. Elements are numbered as in `halvings` below. Collective. \throws InputError
  [[nodiscard]] std::vector<model::BodyLayout> layout(const scene::Scene& scene, const Comm& comm) const;

  /// \param halvings  of each body, of each element: how often its edges should be halved; of geometries also
  /// negative, as they may get coarser; the same on all ranks Returns for each new element of each body the
  /// old one that its centre lies in.
  /// Collective. \throws InputError if Gmsh cannot mesh a geometry that finely.
  std::vector<std::vector<LocalOrdinal>> refine(std::span<const std::vector<double>> halvings,
                                                const Comm& comm);

  /// Into how many parts refine() would cut each element, neighbours that follow among them; of geometries as
  /// many as are wanted. Costs copies of the meshes. Not collective.
  [[nodiscard]] std::vector<std::vector<double>> parts(std::span<const std::vector<double>> halvings) const;
  /// Whether Gmsh makes any of the next meshes: then they differ from the last ones everywhere.
  [[nodiscard]] bool areRemeshed() const;
  /// Area or volume of each element of each body, edges taken as straight.
  [[nodiscard]] std::vector<std::vector<double>> measures() const;

private:
  void remesh(std::span<const std::vector<double>> halvings, std::span<std::vector<LocalOrdinal>> ancestors,
              const Comm& comm);

  scene::Scene scene_;
  std::vector<mesh::SimplexMesh> meshes_; ///< of each body
  std::vector<bool> isRemeshed_;          ///< whether Gmsh makes the next one
  /// By geometry: edges that Gmsh makes, on average, in units of the size it is asked for; measured mesh by
  /// mesh.
  std::map<std::string, double> stretch_;
};

} // namespace epafi::accuracy
