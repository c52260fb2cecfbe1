#include "epafi/model/BodyLayout.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/meshing/GmshFile.hpp"
#include "epafi/meshing/GmshReader.hpp"
#include "epafi/meshing/MeshFiles.hpp"
#include "epafi/model/ClusterSize.hpp"
#include "epafi/model/LayoutInPieces.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace epafi::model {
namespace {

/// Meshes from files by file, factor of mesh sizes, refinements, the order that Gmsh is to give them, and
/// sizes of a STEP file.
using MeshFiles = std::map<std::tuple<std::string, double, int, int, meshing::StepSizes>, meshing::GmshFile>;

MeshFiles::key_type keyOf(const meshing::MeshSource& source) {
  return {source.file, source.sizeFactor, source.refinements, source.order, source.stepSizes};
}

/// The mesh files of a scene, each read once. Collective.
MeshFiles readMeshFiles(const scene::Scene& scene, const Comm& comm) {
  MeshFiles files;
  for (const scene::Body& body : scene.bodies) {
    const meshing::MeshSource& source = body.mesh;
    if (source.file.empty() || files.contains(keyOf(source)))
      continue;
    const auto makeText = [&] {
      return meshing::textOfMeshFile(source.file, source.sizeFactor, source.refinements, source.order,
                                     source.stepSizes);
    };
    files.emplace(keyOf(source), meshing::meshOnAllRanks(source.file, makeText, comm));
  }
  return files;
}

/// Elements in x, y and z of a structured mesh (z: 1 in the plane); zeros of another one.
std::array<int, 3> elementCounts(const mesh::Mesh& mesh) {
  return mesh.structured() != nullptr ? mesh.structured()->elements() : std::array<int, 3>{0, 0, 0};
}

/// Unknowns of a subdomain: factors of many small ones cost less than those of a few large ones, in space
/// above all.
constexpr double unknownsPerPart(int dimension) {
  return dimension == 2 ? 4000 : 1000;
}

int componentsOf(const scene::Body& body) {
  return fem::componentsOf(body.physics);
}

/// With a number of METIS' parts where the scene leaves it open.
scene::Decomposition cutOf(const scene::Body& body, const mesh::Mesh& mesh) {
  scene::Decomposition cut = body.decomposition;
  if (cut.method == scene::Decomposition::Method::metis && cut.parts == 0)
    cut.parts = partsFor(body, mesh);
  return cut;
}

/// Subdomains in x, y and z of a body that is a grid of them.
std::optional<std::array<int, 3>> gridOf(const BodyLayout& body, const scene::Decomposition& cut) {
  if (body.partition || cut.method != scene::Decomposition::Method::grid)
    return std::nullopt;
  return std::array{cut.counts[0], cut.counts[1],
                    body.mesh->structured()->dimension() == 3 ? cut.counts[2] : 1};
}

/// How many subdomains share crosspoints, where the scene leaves it open.
void chooseClusters(int numRanks, std::vector<BodyLayout>& bodies, std::vector<scene::Decomposition>& cuts) {
  GlobalOrdinal number = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (const auto grid = gridOf(bodies[b], cuts[b]))
      number += GlobalOrdinal{1} * (*grid)[0] * (*grid)[1] * (*grid)[2];
    else
      number += bodies[b].partition ? bodies[b].partition->numParts() : cuts[b].parts;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (cuts[b].cluster < 0) {
      const auto grid = gridOf(bodies[b], cuts[b]);
      cuts[b].cluster = grid ? clusterSizeFor(*bodies[b].mesh->structured(), *grid, number, numRanks) : 0;
    }
    bodies[b].cluster = cuts[b].cluster;
  }
}

void requireCut(const scene::Body& body, const scene::Decomposition& cut, const mesh::Mesh& mesh) {
  const std::string where = "body '" + body.name + "' has ";
  if (cut.method == scene::Decomposition::Method::metis) {
    if (cut.parts < 1 || cut.parts > mesh.numElements())
      throw InputError(where + std::to_string(mesh.numElements()) + " elements and cannot be cut into " +
                       std::to_string(cut.parts) + " parts; choose between 1 and " +
                       std::to_string(mesh.numElements()));
    return;
  }
  const std::array<int, 3> elements = elementCounts(mesh);
  if (elements[0] == 0)
    throw InputError("body '" + body.name +
                     "' has a mesh from a file and cannot be cut as a grid; choose the method metis");
  const std::size_t dimension = dimensionOf(mesh.cellType());
  for (std::size_t d = 0; d < dimension; ++d)
    if (cut.counts[d] < 1 || cut.counts[d] > elements[d])
      throw InputError(where + std::to_string(elements[d]) + " elements in " + "xyz"[d] +
                       " and cannot be cut into " + std::to_string(cut.counts[d]) +
                       " subdomains there; choose between 1 and " + std::to_string(elements[d]));
}

std::unique_ptr<const mesh::Mesh> makeMesh(const scene::Body& body, const MeshFiles& files) {
  const meshing::MeshSource& source = body.mesh;
  if (!source.file.empty())
    return std::make_unique<const mesh::UnstructuredMesh>(
        files.at(keyOf(source)).body(source, source.order, source.innerNodes));
  return structuredMesh(source);
}

/// Whether two bodies are meshed and cut alike: their partitions are the same.
bool areCutAlike(const mesh::Mesh& a, const scene::Decomposition& cut, const mesh::Mesh& b,
                 const scene::Decomposition& other) {
  if (elementCounts(a) != elementCounts(b) || elementCounts(a)[0] == 0 || cut.method != other.method ||
      cut.cluster > 1 || other.cluster > 1)
    return false;
  return cut.method == scene::Decomposition::Method::metis ? cut.parts == other.parts
                                                           : cut.counts == other.counts;
}

/// Collective.
std::shared_ptr<const meshing::Partition> cutByMetis(const scene::Body& body, int parts,
                                                     const mesh::Mesh& mesh, const Comm& comm) {
  try {
    return std::make_shared<const meshing::GraphPartition>(mesh, parts, comm, kindOfParts(body));
  } catch (const InputError& error) { // the same on all ranks
    throw InputError("body '" + body.name + "': " + error.what());
  }
}

/// Collective.
std::shared_ptr<const meshing::Partition> makePartition(const scene::Body& body,
                                                        const scene::Decomposition& cut,
                                                        const mesh::Mesh& mesh, const Comm& comm) {
  std::shared_ptr<const meshing::Partition> parts;
  if (cut.method == scene::Decomposition::Method::metis)
    parts = cutByMetis(body, cut.parts, mesh, comm);
  else
    parts = std::make_shared<const meshing::GridPartition>(*mesh.structured(), cut.counts);
  if (cut.cluster <= 1)
    return parts;
  return std::make_shared<const meshing::GroupedPartition>(std::move(parts), mesh, cut.cluster);
}

/// Bodies that touch have the same unknowns; a vector of the dual problem knows no other. Plane bodies and
/// solids of revolution do not touch.
void requireSameComponents(const scene::Scene& scene) {
  for (const scene::Body& body : scene.bodies)
    if (componentsOf(body) != componentsOf(scene.bodies.front()))
      throw InputError(
          "the bodies '" + scene.bodies.front().name + "' and '" + body.name + "' have " +
          std::to_string(componentsOf(scene.bodies.front())) + " and " + std::to_string(componentsOf(body)) +
          " unknowns a node; all bodies of a scene must have the same physics or the same dimension");
  for (const scene::Body& body : scene.bodies)
    if ((body.physics == fem::Physics::axisymmetric) !=
        (scene.bodies.front().physics == fem::Physics::axisymmetric))
      throw InputError("the physics of the bodies '" + scene.bodies.front().name + "' and '" + body.name +
                       "' are " + toString(scene.bodies.front().physics) + " and " + toString(body.physics) +
                       "; beside a solid of revolution all bodies of a scene must be axisymmetric");
}

} // namespace

std::vector<std::unique_ptr<const mesh::Mesh>> meshBodies(const scene::Scene& scene, const Comm& comm) {
  std::vector<std::unique_ptr<const mesh::Mesh>> made;
  const MeshFiles files = readMeshFiles(scene, comm);
  collectively(comm, [&] {
    for (const scene::Body& body : scene.bodies)
      made.push_back(makeMesh(body, files));
  });
  return made;
}

std::vector<BodyLayout> layoutBodies(const scene::Scene& scene, const Comm& comm, Meshes meshes) {
  collectively(comm, [&] { requireSameComponents(scene); });
  const bool areSplit = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                    [](const scene::Body& body) { return meshing::isSplit(body.mesh.file); });
  if (meshes == Meshes::pieces && (areSplit || comm.getSize() > 1))
    return layoutInPieces(scene, comm);
  return cutBodies(scene, meshBodies(scene, comm), comm);
}

std::unique_ptr<const mesh::Mesh> structuredMesh(const meshing::MeshSource& source) {
  return std::make_unique<const mesh::StructuredMesh>(source.box, source.elements, source.order);
}

meshing::Parts kindOfParts(const scene::Body& body) {
  return body.reducedIntegration ? meshing::Parts::braced : meshing::Parts::connected;
}

int partsFor(const scene::Body& body, const mesh::Mesh& mesh) {
  const double unknowns = static_cast<double>(mesh.numNodes()) * componentsOf(body),
               parts = std::ceil(unknowns / unknownsPerPart(dimensionOf(mesh.cellType())));
  return static_cast<int>(std::clamp(parts, 1.0, static_cast<double>(mesh.numElements())));
}

std::vector<BodyLayout> cutBodies(const scene::Scene& scene,
                                  std::vector<std::unique_ptr<const mesh::Mesh>> meshes, const Comm& comm,
                                  std::vector<std::shared_ptr<const meshing::Partition>> partitions) {
  std::vector<BodyLayout> bodies;
  std::vector<scene::Decomposition> cuts;
  partitions.resize(meshes.size());
  collectively(comm, [&] {
    for (std::size_t b = 0; b < meshes.size(); ++b) {
      bodies.push_back({.name = scene.bodies[b].name,
                        .mesh = std::move(meshes[b]),
                        .partition = std::move(partitions[b])});
      cuts.push_back(scene.bodies[b].decomposition);
      if (bodies.back().partition)
        continue;
      cuts.back() = cutOf(scene.bodies[b], *bodies.back().mesh);
      requireCut(scene.bodies[b], cuts.back(), *bodies.back().mesh);
    }
    chooseClusters(comm.getSize(), bodies, cuts);
  });
  int firstSubdomain = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].partition) {
      std::size_t alike = 0; // the first body that is cut like this one, perhaps itself
      while (alike < b && (!bodies[alike].mesh ||
                           !areCutAlike(*bodies[alike].mesh, cuts[alike], *bodies[b].mesh, cuts[b])))
        ++alike;
      bodies[b].partition = alike < b ? bodies[alike].partition
                                      : makePartition(scene.bodies[b], cuts[b], *bodies[b].mesh, comm);
    }
    bodies[b].firstSubdomain = firstSubdomain;
    firstSubdomain += bodies[b].partition->numParts();
  }
  return bodies;
}

Share shareOf(const std::vector<BodyLayout>& bodies, int rank, int ranks) {
  const GlobalOrdinal number = bodies.back().firstSubdomain + bodies.back().partition->numParts();
  // The first rank whose even share begins at a subdomain or behind.
  const auto firstRankAt = [&](GlobalOrdinal subdomain) { return (subdomain * ranks + number - 1) / number; };
  const auto first = [&](GlobalOrdinal r) {
    const GlobalOrdinal even = r * number / ranks;
    for (const BodyLayout& body : bodies)
      if (const GlobalOrdinal inBody = even - body.firstSubdomain, parts = body.partition->numParts();
          body.cluster > 1 && inBody >= 0 && inBody < parts) {
        const GlobalOrdinal inCluster = inBody % body.cluster, begin = even - inCluster,
                            size = std::min<GlobalOrdinal>(body.cluster, parts - (inBody - inCluster)),
                            before = firstRankAt(begin), sharers = firstRankAt(begin + size) - before;
        return static_cast<int>(begin + (r - before) * size / sharers);
      }
    return static_cast<int>(even);
  };
  return {first(rank), first(rank + 1)};
}

Share shareOf(const std::vector<BodyLayout>& bodies, const Comm& comm) {
  return shareOf(bodies, comm.getRank(), comm.getSize());
}

std::vector<GlobalOrdinal> firstNodes(const std::vector<BodyLayout>& bodies) {
  std::vector<GlobalOrdinal> first(1, 0);
  for (const BodyLayout& body : bodies)
    first.push_back(first.back() + body.mesh->numNodes());
  return first;
}

int lowestPartAt(const BodyLayout& body, GlobalOrdinal node) {
  std::vector<GlobalOrdinal> elements;
  body.mesh->nodeElements(node, elements);
  int lowest = body.partition->numParts();
  for (const GlobalOrdinal element : elements)
    lowest = std::min(lowest, body.partition->partOf(element));
  return lowest;
}

std::unique_ptr<fem::BodyModel> makeModel(const scene::Body& body, const mesh::Mesh& mesh) {
  return std::make_unique<fem::BodyModel>(body, mesh);
}

} // namespace epafi::model
