#include "epafi/model/LayoutInPieces.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/model/MeshPieces.hpp"
#include "epafi/model/SplitFiles.hpp"

#include <Teuchos_DefaultSerialComm.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace epafi::model {
namespace {

bool isFromOneFile(const scene::Body& body) {
  return !body.mesh.file.empty() && !meshing::isSplit(body.mesh.file);
}

/// All of it on one rank, numbers of nodes for keys; nothing on the others. Collective.
meshing::LooseMesh looseMeshOf(const BodyLayout* whole, const Comm& comm) {
  std::vector<meshing::MeshShare> shares;
  meshing::FacetList facets;
  collectively(comm, [&] {
    if (whole == nullptr)
      return;
    shares.push_back({whole->mesh.get(), whole->partition.get(), [](GlobalOrdinal node) { return node; }});
    for (const std::string& name : whole->mesh->surfaceNames()) {
      const mesh::Surface surface = whole->mesh->surface(name);
      for (std::size_t f = 0; f < surface.numFacets(); ++f)
        facets.add(name, surface.corners(f));
    }
    for (const std::string& name : whole->mesh->nodeSetNames())
      for (const GlobalOrdinal node : whole->mesh->nodeSet(name))
        facets.add(name, std::array{node});
  });
  return looseMeshOf(shares, std::make_shared<const meshing::FacetList>(gathered(facets, comm)), comm);
}

using LooseMeshes = std::vector<std::optional<meshing::LooseMesh>>; ///< of each body, if it comes from files

/// Rank 0 makes a scene of the bodies that come from one file each, as a single rank would, and looks at them
/// whole. Collective.
void readOnFirst(const scene::Scene& scene, const Comm& comm, LooseMeshes& meshes) {
  scene::Scene fromFiles(scene);
  std::erase_if(fromFiles.bodies, [](const scene::Body& body) { return !isFromOneFile(body); });
  std::vector<BodyLayout> whole; // on rank 0
  collectively(comm, [&] {
    if (comm.getRank() != 0 || fromFiles.bodies.empty())
      return;
    whole = layoutBodies(fromFiles, Teuchos::SerialComm<int>());
    for (std::size_t b = 0; b < whole.size(); ++b)
      makeModel(fromFiles.bodies[b], *whole[b].mesh); // says what is wrong
  });
  for (std::size_t b = 0, next = 0; b < meshes.size(); ++b)
    if (isFromOneFile(scene.bodies[b])) {
      meshes[b] = looseMeshOf(whole.empty() ? nullptr : &whole[next], comm);
      if (!whole.empty())
        whole[next] = {};
      ++next;
    }
}

/// Each rank its files. Collective.
void readOnAll(const scene::Scene& scene, const Comm& comm, LooseMeshes& meshes) {
  std::map<std::string, std::vector<std::size_t>> bodiesIn;
  for (std::size_t b = 0; b < meshes.size(); ++b)
    if (meshing::isSplit(scene.bodies[b].mesh.file))
      bodiesIn[scene.bodies[b].mesh.file].push_back(b);
  for (const auto& [files, numbers] : bodiesIn) {
    std::vector<const scene::Body*> bodies;
    for (const std::size_t b : numbers)
      bodies.push_back(&scene.bodies[b]);
    std::vector<meshing::LooseMesh> read = readSplitFiles(bodies, comm);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      meshes[numbers[i]] = std::move(read[i]);
  }
}

} // namespace

std::vector<BodyLayout> layoutInPieces(const scene::Scene& scene, const Comm& comm) {
  LooseMeshes loose(scene.bodies.size());
  readOnFirst(scene, comm, loose);
  readOnAll(scene, comm, loose);
  std::vector<std::unique_ptr<const mesh::Mesh>> meshes(scene.bodies.size());
  std::vector<std::shared_ptr<const meshing::Partition>> partitions(scene.bodies.size());
  collectively(comm, [&] {
    for (std::size_t b = 0; b < meshes.size(); ++b)
      if (loose[b])
        partitions[b] =
            std::make_shared<const meshing::HeldPartition>(loose[b]->numParts, meshing::HeldElements{});
      else
        meshes[b] = structuredMesh(scene.bodies[b].mesh);
  });
  std::vector<BodyLayout> bodies = cutBodies(scene, std::move(meshes), comm, std::move(partitions));
  const Share share = shareOf(bodies, comm);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!loose[b])
      continue;
    const int first = bodies[b].firstSubdomain, number = bodies[b].partition->numParts();
    const Share own{std::clamp(share.begin - first, 0, number), std::clamp(share.end - first, 0, number)};
    try {
      dealOut(std::move(*loose[b]), own, comm, bodies[b]);
    } catch (const InputError& error) { // the same on all ranks
      throw InputError("body '" + scene.bodies[b].name + "': " + error.what());
    }
    loose[b].reset();
  }
  return bodies;
}

} // namespace epafi::model
