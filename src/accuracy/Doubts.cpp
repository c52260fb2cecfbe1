#include "epafi/accuracy/Doubts.hpp"

#include "epafi/fem/HookesLaw.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

namespace epafi::accuracy {
namespace {

using Eigen::Vector3d;

Vector3d at(const mesh::Mesh& mesh, GlobalOrdinal node) {
  const Point point = mesh.point(node);
  return {point[0], point[1], point[2]};
}

std::vector<Vector3d> cornersOf(const mesh::Mesh& mesh, const mesh::Surface& surface, std::size_t facet) {
  std::vector<Vector3d> corners;
  for (const GlobalOrdinal node : surface.corners(facet))
    corners.push_back(at(mesh, node));
  return corners;
}

/// Area vector; of a line its normal times its length.
Vector3d areaOf(const std::vector<Vector3d>& x) {
  if (x.size() == 2)
    return (x[1] - x[0]).cross(Vector3d::UnitZ());
  return x.size() == 3 ? Vector3d((x[1] - x[0]).cross(x[2] - x[0]) / 2)
                       : Vector3d((x[2] - x[0]).cross(x[3] - x[1]) / 2);
}

/// Whether any further node of a facet lies off the middle of its edge.
bool isCurved(const mesh::Mesh& mesh, const mesh::Surface& surface, std::size_t facet) {
  constexpr double straight = 1e-6;
  const auto nodes = surface.facet(facet);
  const std::vector<Vector3d> corners = cornersOf(mesh, surface, facet);
  const std::size_t edges = corners.size() == 2 ? 1 : corners.size();
  for (std::size_t i = 0; corners.size() + i < nodes.size() && i < edges; ++i) {
    const Vector3d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((at(mesh, nodes[corners.size() + i]) - (a + b) / 2).norm() > straight * (b - a).norm())
      return true;
  }
  return false;
}

double width(const std::vector<Vector3d>& corners, double area, double edge) {
  return corners.size() == 2 ? area : (corners.size() == 3 ? 2 : 1) * area / edge;
}

std::string inWords(double value) {
  std::ostringstream text;
  text.precision(2);
  text << value;
  return text.str();
}

double sagOf(const model::Decomposition& decomposition, int body, const std::string& surface) {
  if (body < 0)
    return 0;
  const mesh::Mesh& mesh = *decomposition.bodies[body].mesh;
  if (mesh.structured() != nullptr) // flat
    return 0;
  return facetSag(mesh, mesh.surface(surface));
}

} // namespace

bool locks(const scene::Body& body) {
  constexpr double nearHalf = 0.48; // λ/μ = 24
  if (body.physics == fem::Physics::membrane || body.physics == fem::Physics::planeStress)
    return false;
  const auto isNear = [](const fem::Material& material) {
    return fem::meanModuli(material).poissonsRatio >= nearHalf;
  };
  return isNear(body.material) || std::any_of(body.regions.begin(), body.regions.end(),
                                              [&](const auto& region) { return isNear(region.material); });
}

double facetSag(const mesh::Mesh& mesh, const mesh::Surface& surface) {
  constexpr double edgeOfBody = 0.7; // rad
  std::map<std::array<GlobalOrdinal, 2>, std::vector<std::size_t>> joints;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    if (isCurved(mesh, surface, f))
      continue;
    const auto nodes = surface.corners(f);
    const std::size_t count = nodes.size();
    for (std::size_t i = 0; i < count; ++i) {
      const GlobalOrdinal a = nodes[i], b = count == 2 ? a : nodes[(i + 1) % count];
      joints[{std::min(a, b), std::max(a, b)}].push_back(f);
    }
  }
  double sag = 0;
  for (const auto& [joint, facets] : joints) {
    if (facets.size() != 2)
      continue;
    const auto first = cornersOf(mesh, surface, facets[0]), second = cornersOf(mesh, surface, facets[1]);
    const Vector3d n = areaOf(first), m = areaOf(second);
    const double turn = std::atan2(n.cross(m).norm(), n.dot(m)),
                 edge = (at(mesh, joint[1]) - at(mesh, joint[0])).norm();
    const double across = (width(first, n.norm(), edge) + width(second, m.norm(), edge)) / 2;
    if (turn < edgeOfBody)
      sag = std::max(sag, across * turn / 8);
  }
  return sag;
}

std::string doubts(const scene::Scene& scene, const model::Decomposition& decomposition,
                   const std::vector<double>& closing) {
  std::string text;
  const auto add = [&](const std::string& sentence) { text += (text.empty() ? "" : ". ") + sentence; };
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (locks(scene.bodies[b]) && mesh::orderOf(decomposition.bodies[b].mesh->cellType()) == 1)
      add("body " + scene.bodies[b].name +
          ": linear elements lock where Poisson's ratio is near 0.5, and the estimated error knows only a "
          "part "
          "of that; use Order 2");
  constexpr double ofItsSize = 0.25;
  for (std::size_t c = 0; c < decomposition.contacts.size(); ++c) {
    const contact::ContactLayout& layout = decomposition.contacts[c];
    const scene::SurfaceContact& pair = scene.contacts[layout.number];
    if (scene::isAlongEdges(scene, pair))
      continue;
    const double sag = std::max(sagOf(decomposition, pair.first, pair.firstSurface),
                                sagOf(decomposition, pair.second, pair.secondSurface));
    if (sag > 0 && sag >= ofItsSize * closing[c] && closing[c] > 0)
      add("contact " + layout.name + ": straight facets deviate from a smooth surface by up to " +
          inWords(sag) + ", and the sides are pressed together by no more than " + inWords(closing[c]) +
          ", so that forces and pressures are the facets' own; use Order 2 on the curved geometry (.geo), or "
          "a "
          "finer mesh");
  }
  return text;
}

} // namespace epafi::accuracy
