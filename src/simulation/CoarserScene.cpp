#include "epafi/simulation/CoarserScene.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/mesh/MeshPart.hpp"
#include "epafi/mesh/SimplexMesh.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace epafi::simulation {
namespace {

/// Subdomains that are `times` smaller in unknowns need not be as many.
void mergeParts(scene::Decomposition& decomposition, int times) {
  if (decomposition.parts > 0)
    decomposition.parts = std::max(1, decomposition.parts / times);
}

/// Half as many cells along each axis, or elements twice as large; false if that cannot be.
bool halve(scene::Body& body, int dimension) {
  meshing::MeshSource& mesh = body.mesh;
  if (mesh.file.empty()) {
    scene::Decomposition& cut = body.decomposition;
    const std::size_t axes = dimension;
    if (std::all_of(mesh.elements.begin(), mesh.elements.begin() + dimension,
                    [](int count) { return count == 1; }))
      return false;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const bool isEven = mesh.elements[axis] % 2 == 0;
      mesh.elements[axis] = (mesh.elements[axis] + 1) / 2;
      const int counts = std::max(1, cut.counts[axis] / 2);
      cut.counts[axis] =
          isEven ? std::gcd(mesh.elements[axis], counts) : std::min(mesh.elements[axis], counts);
    }
  } else if (mesh.refinements > 0) {
    --mesh.refinements;
  } else if (mesh.file.ends_with(".geo")) {
    mesh.sizeFactor *= 2;
  } else {
    return false;
  }
  mergeParts(body.decomposition, dimension == 2 ? 4 : 8);
  return true;
}

} // namespace

std::optional<CoarserScene> coarserScene(const scene::Scene& scene,
                                         const std::vector<model::BodyLayout>& fine, const Comm& comm) {
  CoarserScene coarser{scene, {}, {}};
  const auto isQuadratic = [&](std::size_t b) { return mesh::orderOf(fine[b].mesh->cellType()) == 2; };
  const std::size_t number = fine.size();
  bool hasQuadratic = false, isCoarser = false;
  for (std::size_t b = 0; b < number; ++b)
    hasQuadratic = hasQuadratic || isQuadratic(b);
  const bool areSimplices = std::all_of(
      fine.begin(), fine.end(), [](const model::BodyLayout& body) { return isOfSimplices(*body.mesh); });
  if (!(hasQuadratic && areSimplices) && // others are read once more, and whole
      std::any_of(scene.bodies.begin(), scene.bodies.end(),
                  [](const scene::Body& body) { return meshing::isSplit(body.mesh.file); }))
    return std::nullopt;
  if (!hasQuadratic) {
    for (scene::Body& body : coarser.scene.bodies)
      isCoarser = halve(body, dimensionOf(body.physics)) || isCoarser;
    if (!isCoarser)
      return std::nullopt;
    coarser.bodies = model::layoutBodies(coarser.scene, comm);
    coarser.means = "elements twice as large";
    return coarser;
  }
  coarser.means = "elements of order 1";
  for (std::size_t b = 0; b < number; ++b) {
    coarser.scene.bodies[b].mesh.order = 1;
    coarser.scene.bodies[b].reducedIntegration = false;
    if (isQuadratic(b))
      mergeParts(coarser.scene.bodies[b].decomposition, dimensionOf(scene.bodies[b].physics) == 2 ? 4 : 8);
  }
  if (!areSimplices) {
    coarser.bodies = model::layoutBodies(coarser.scene, comm);
    return coarser;
  }
  std::vector<std::unique_ptr<const mesh::Mesh>> meshes;
  std::vector<std::shared_ptr<const meshing::Partition>> partitions;
  collectively(comm, [&] { // Gmsh is not to mesh a geometry once more
    for (const model::BodyLayout& body : fine) {
      const mesh::MeshPart* piece = body.mesh->part();
      if (piece != nullptr)
        meshes.push_back(piece->ofOrder1());
      else
        meshes.push_back(
            std::make_unique<const mesh::UnstructuredMesh>(arraysOf(simplicesOf(*body.mesh), 1)));
      partitions.push_back(piece != nullptr ? body.partition
                                            : nullptr); // what is dealt out stays cut as it is
    }
  });
  coarser.bodies = model::cutBodies(coarser.scene, std::move(meshes), comm, std::move(partitions));
  return coarser;
}

} // namespace epafi::simulation
