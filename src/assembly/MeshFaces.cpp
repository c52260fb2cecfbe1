#include "epafi/assembly/MeshFaces.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/SmoothPieces.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace epafi::assembly {
namespace {

using Corners = std::set<std::vector<GlobalOrdinal>>;

/// What facets are told by, whatever their order.
Corners cornersOf(const mesh::Surface& surface) {
  Corners all;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    std::vector<GlobalOrdinal> corners(surface.corners(f).begin(), surface.corners(f).end());
    std::sort(corners.begin(), corners.end());
    all.insert(corners);
  }
  return all;
}

std::vector<Point> pointsOf(const mesh::Mesh& mesh, const mesh::Surface& surface, std::size_t facet) {
  std::vector<Point> points;
  for (const GlobalOrdinal node : surface.facet(facet))
    points.push_back(mesh.point(node));
  return points;
}

Eigen::Vector3d centreOf(const std::vector<Point>& points, std::size_t numCorners) {
  const Point centre = mesh::centreOf(std::span(points).first(numCorners));
  return {centre[0], centre[1], centre[2]};
}

/// All but number, body and group.
Face faceOf(const mesh::Mesh& mesh, const mesh::Surface& surface) {
  Face face;
  Eigen::Vector3d sum(0, 0, 0), centre(0, 0, 0);
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const std::vector<Point> points = pointsOf(mesh, surface, f);
    const Eigen::Vector3d vector = mesh::areaVector(surface.typeOf(f), points);
    sum += vector;
    face.area += vector.norm();
    centre += vector.norm() * centreOf(points, surface.corners(f).size());
  }
  centre /= face.area;
  constexpr double flat = 1e-9;
  face.kind = sum.norm() > (1 - flat) * face.area ? "plane" : "surface";
  for (std::size_t d = 0; d < 3; ++d) {
    face.centre[d] = centre[index(d)];
    face.axis[d] = face.kind == "plane" ? sum[index(d)] / sum.norm() : 0;
  }
  return face;
}

/// The centre of the facet that is nearest to the face's.
Point placeOn(const mesh::Mesh& mesh, const mesh::Surface& surface, const Face& face) {
  const Eigen::Vector3d middle(face.centre[0], face.centre[1], face.centre[2]);
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector3d place(0, 0, 0);
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const Eigen::Vector3d centre = centreOf(pointsOf(mesh, surface, f), surface.corners(f).size());
    if ((centre - middle).norm() < least) {
      least = (centre - middle).norm();
      place = centre;
    }
  }
  return {place[0], place[1], place[2]};
}

mesh::Surface partOf(const mesh::Surface& surface, const std::vector<std::size_t>& facets) {
  mesh::Surface part{surface.facetType, {}, {}};
  for (const std::size_t facet : facets) {
    part.add(surface.facet(facet));
    part.elements.push_back(surface.elements[facet]);
  }
  return part;
}

class FaceMaker {
public:
  void add(const MeshedBody& body) {
    const mesh::Mesh& mesh = *body.mesh;
    std::vector<Point> points;
    for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
      points.push_back(mesh.point(node));
    const auto [lower, upper] = mesh::boxOf(points);
    result_.assembly.solids.push_back({body.name, 0, {lower, upper}});
    std::map<Corners, std::string> named;
    for (const std::string& name : mesh.surfaceNames())
      named.emplace(cornersOf(mesh.surface(name)), name);
    const auto* const unstructured = dynamic_cast<const mesh::UnstructuredMesh*>(&mesh);
    if (unstructured == nullptr) {
      for (const std::string& name : mesh.surfaceNames())
        addFace(mesh, mesh.surface(name), name);
      return;
    }
    const mesh::Surface boundary = unstructured->boundary();
    for (const auto& piece :
         mesh::smoothPieces(boundary, [&](GlobalOrdinal node) { return mesh.point(node); })) {
      mesh::Surface surface = partOf(boundary, piece);
      const auto known = named.find(cornersOf(surface));
      addFace(mesh, std::move(surface), known == named.end() ? "" : known->second);
    }
  }

  MeshFaces result_;

private:
  void addFace(const mesh::Mesh& mesh, mesh::Surface surface, const std::string& name) {
    std::vector<Face>& faces = result_.assembly.faces;
    Face face = faceOf(mesh, surface);
    face.number = static_cast<int>(faces.size()) + 1;
    face.solid = static_cast<int>(result_.assembly.solids.size()) - 1;
    face.group =
        !name.empty() ? name : mesh::wordsOfPlace(placeOn(mesh, surface, face), dimensionOf(mesh.cellType()));
    faces.push_back(face);
    result_.faces.push_back({face.solid, std::move(surface)});
  }
};

} // namespace

std::vector<int> MeshFaces::facesIn(std::span<const MeshedBody> bodies, int body,
                                    const std::string& surface) const {
  const mesh::Mesh& mesh = *bodies[index(body)].mesh;
  const std::vector<std::string> names = mesh.surfaceNames();
  std::vector<int> found;
  if (std::find(names.begin(), names.end(), surface) == names.end())
    return found;
  const Corners wanted = cornersOf(mesh.surface(surface));
  for (int f = 0; f < std::ssize(faces); ++f) {
    const Corners own = faces[f].body == body ? cornersOf(faces[f].surface) : Corners();
    if (std::any_of(own.begin(), own.end(), [&](const auto& facet) { return wanted.contains(facet); }))
      found.push_back(f);
  }
  return found;
}

MeshFaces meshFacesOf(std::span<const MeshedBody> bodies) {
  FaceMaker maker;
  for (const MeshedBody& body : bodies)
    maker.add(body);
  return std::move(maker.result_);
}

} // namespace epafi::assembly
