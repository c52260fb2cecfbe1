#include "epafi/accuracy/RefinableMeshes.hpp"

#include "epafi/accuracy/FirstGrid.hpp"
#include "epafi/accuracy/PointLocation.hpp"
#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"
#include "epafi/meshing/GmshReader.hpp"
#include "epafi/meshing/MeshFiles.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace epafi::accuracy {
namespace {

using mesh::SimplexMesh;

std::vector<Point> cornersOf(const SimplexMesh& mesh, const SimplexMesh::Element& element) {
  std::vector<Point> corners;
  for (int i = 0; i <= mesh.dimension; ++i)
    corners.push_back(mesh.points[index(element.corners[index(i)])]);
  return corners;
}

/// Of each element the one of another mesh that its centre lies in.
std::vector<LocalOrdinal> elementsAround(const SimplexMesh& inner, const SimplexMesh& outer) {
  const mesh::UnstructuredMesh mesh(arraysOf(outer, 1));
  const PointLocation location(mesh);
  std::vector<LocalOrdinal> around;
  for (const SimplexMesh::Element& element : inner.elements)
    around.push_back(
        static_cast<LocalOrdinal>(location.find(mesh::centreOf(cornersOf(inner, element))).element));
  return around;
}

/// Mean length of an element's edges.
double sizeOf(const SimplexMesh& mesh, const SimplexMesh::Element& element) {
  double sum = 0;
  int number = 0;
  for (int i = 1; i <= mesh.dimension; ++i)
    for (int j = 0; j < i; ++j, ++number) {
      const Point &a = mesh.points[index(element.corners[index(i)])],
                  &b = mesh.points[index(element.corners[index(j)])];
      sum += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    }
  return sum / number;
}

/// How often each element is to be bisected.
std::vector<int> timesOf(const std::vector<double>& halvings, int dimension) {
  std::vector<int> times;
  double rest = 0; // of rounding, carried on: all together are split as often as is wanted
  for (const double halving : halvings) {
    const double wanted = std::max(0.0, dimension * halving);
    times.push_back(wanted > 0 ? std::max(0, static_cast<int>(std::lround(wanted + rest))) : 0);
    rest += wanted - times.back();
  }
  return times;
}

/// Adds the sizes that are wanted in a body: at nodes the (geometric) means of the elements around.
void addSizes(const SimplexMesh& mesh, const std::vector<double>& halvings, double stretch,
              mesh::MeshSizes& sizes) {
  std::vector<double> sum(mesh.points.size(), 0), number(mesh.points.size(), 0);
  const auto count = index(mesh.dimension) + 1;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const double wanted = std::log2(sizeOf(mesh, mesh.elements[e]) / stretch) - halvings[e];
    for (std::size_t i = 0; i < count; ++i) {
      sum[index(mesh.elements[e].corners[i])] += wanted;
      ++number[index(mesh.elements[e].corners[i])];
    }
  }
  constexpr double steps = 16; // a halving: what differs in round-off gives the same mesh
  for (const SimplexMesh::Element& element : mesh.elements)
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t node = index(element.corners[i]);
      sizes.corners.push_back(mesh.points[node]);
      sizes.sizes.push_back(std::exp2(std::round(steps * sum[node] / number[node]) / steps));
    }
}

} // namespace

RefinableMeshes::RefinableMeshes(const scene::Scene& scene, const Comm& comm) : scene_(scene) {
  for (const scene::Body& body : scene_.bodies)
    if (body.reducedIntegration)
      throw InputError(
          "body '" + body.name +
          "' is integrated by fewer points, which goes with quadrilaterals of 8 nodes and "
          "hexahedra of 20 and prisms, but meshes on the way to a target are made of triangles or "
          "tetrahedra; choose the integration \"full\", or solve it on its own mesh");
  const bool hasFiles = std::any_of(scene_.bodies.begin(), scene_.bodies.end(),
                                    [](const scene::Body& body) { return !body.mesh.file.empty(); });
  scene::Scene uncut(scene_);
  for (scene::Body& body : uncut.bodies) {
    body.decomposition = {scene::Decomposition::Method::metis, {1, 1, 1}, 1};
    body.mesh.innerNodes = mesh::InnerNodes::added; // of them edges between simplices are bent
    if (meshing::isGeometry(body.mesh.file))
      body.mesh.order = 2; // on the geometry; nodes on edges can be left out
  }
  std::vector<model::BodyLayout> bodies;
  if (hasFiles)
    bodies = model::layoutBodies(uncut, comm);
  collectively(comm, [&] {
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const std::string& file = scene_.bodies[b].mesh.file;
      meshes_.push_back(file.empty() ? firstGrid(scene_, b) : simplicesOf(*bodies[b].mesh));
      isRemeshed_.push_back(meshing::isGeometry(file) && isOfSimplices(*bodies[b].mesh));
    }
  });
}

scene::Scene RefinableMeshes::scene(int order) const {
  scene::Scene scene(scene_);
  for (scene::Body& body : scene.bodies) {
    body.mesh.order = order;
    body.decomposition.method = scene::Decomposition::Method::metis;
    body.decomposition.parts = 0; // as many as suit
  }
  return scene;
}

std::vector<model::BodyLayout> RefinableMeshes::layout(const scene::Scene& scene, const Comm& comm) const {
  std::vector<std::unique_ptr<const mesh::Mesh>> meshes;
  collectively(comm, [&] {
    for (std::size_t b = 0; b < meshes_.size(); ++b)
      meshes.push_back(
          std::make_unique<const mesh::UnstructuredMesh>(arraysOf(meshes_[b], scene.bodies[b].mesh.order)));
  });
  return model::cutBodies(scene, std::move(meshes), comm);
}

std::vector<std::vector<LocalOrdinal>> RefinableMeshes::refine(std::span<const std::vector<double>> halvings,
                                                               const Comm& comm) {
  std::vector<std::vector<LocalOrdinal>> ancestors(meshes_.size());
  remesh(halvings, ancestors, comm);
  collectively(comm, [&] {
    for (std::size_t b = 0; b < meshes_.size(); ++b) {
      if (!ancestors[b].empty())
        continue;
      ancestors[b] = bisect(meshes_[b], timesOf(halvings[b], meshes_[b].dimension));
    }
  });
  return ancestors;
}

std::vector<std::vector<double>> RefinableMeshes::parts(std::span<const std::vector<double>> halvings) const {
  std::vector<std::vector<double>> parts;
  for (std::size_t b = 0; b < meshes_.size(); ++b) {
    std::vector<double>& own = parts.emplace_back();
    if (isRemeshed_[b]) {
      for (const double halving : halvings[b])
        own.push_back(std::exp2(meshes_[b].dimension * halving));
      continue;
    }
    own.assign(halvings[b].size(), 0);
    SimplexMesh copy(meshes_[b]);
    for (const LocalOrdinal ancestor : bisect(copy, timesOf(halvings[b], copy.dimension)))
      ++own[index(ancestor)];
  }
  return parts;
}

/// Each geometry once, with the sizes of all its bodies: of one body alone they would be carried on into the
/// others, and these be meshed as finely as their contact.
void RefinableMeshes::remesh(std::span<const std::vector<double>> halvings,
                             std::span<std::vector<LocalOrdinal>> ancestors, const Comm& comm) {
  std::map<std::string, std::vector<std::size_t>> geometries; // and their bodies
  for (std::size_t b = 0; b < meshes_.size(); ++b)
    if (isRemeshed_[b])
      geometries[scene_.bodies[b].mesh.file].push_back(b);
  for (const auto& [geometry, bodies] : geometries) {
    const int dimension = meshes_[bodies.front()].dimension;
    double& stretch = stretch_.try_emplace(geometry, dimension == 2 ? 1.05 : 1.25).first->second;
    mesh::MeshSizes sizes{dimension, {}, {}};
    double before = 0, wanted = 0, made = 0; // elements
    for (const std::size_t b : bodies) {
      addSizes(meshes_[b], halvings[b], stretch, sizes);
      before += static_cast<double>(halvings[b].size());
      for (const double halving : halvings[b])
        wanted += std::exp2(dimension * halving);
    }
    const double factor = scene_.bodies[bodies.front()].mesh.sizeFactor; // for what the geometry reads it
    const auto makeText = [&, &name = geometry] {
      return meshing::textOfGeometry(name, factor, mesh::SizeField(std::move(sizes)));
    };
    std::string text = meshing::textOnAllRanks(makeText, comm);
    if (text.empty()) { // bisected as what a mesh file has
      for (const std::size_t b : bodies)
        isRemeshed_[b] = false;
      continue;
    }
    collectively(comm, [&] {
      const meshing::GmshFile mesh(meshing::readMsh(geometry, std::move(text)));
      for (const std::size_t b : bodies) {
        SimplexMesh finer = simplicesOf(mesh.body(scene_.bodies[b].mesh, 2));
        ancestors[b] = elementsAround(finer, meshes_[b]);
        meshes_[b] = std::move(finer);
        made += static_cast<double>(meshes_[b].elements.size());
      }
    });
    constexpr double clear = 1.5, poor = 0.5; // numbers of elements that a geometry gives stand in the way
    if (wanted > clear * before && made < poor * wanted)
      for (const std::size_t b : bodies) {
        isRemeshed_[b] = false;
        if (made == before) // the mesh is the old one
          ancestors[b] = {};
      }
    stretch *= std::clamp(std::pow(wanted / made, 1.0 / dimension), 0.7, 1.4);
  }
}

bool RefinableMeshes::areRemeshed() const {
  return std::find(isRemeshed_.begin(), isRemeshed_.end(), true) != isRemeshed_.end();
}

std::vector<std::vector<double>> RefinableMeshes::measures() const {
  std::vector<std::vector<double>> measures;
  for (const SimplexMesh& mesh : meshes_) {
    std::vector<double>& own = measures.emplace_back();
    const auto type = mesh.dimension == 2 ? mesh::CellType::triangle : mesh::CellType::tetrahedron;
    for (const SimplexMesh::Element& element : mesh.elements)
      own.push_back(mesh::measureOf(type, cornersOf(mesh, element)));
  }
  return measures;
}

} // namespace epafi::accuracy
