#include "epafi/model/ContactSurfaces.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/MortarIntegrals.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/mesh/BoxTree.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace epafi::model {
namespace {

std::vector<mesh::BoxTree::Box> boxesOf(const mesh::Mesh& mesh, const mesh::Surface& surface, double margin) {
  std::vector<mesh::BoxTree::Box> boxes;
  std::vector<Point> points;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    mesh.pointsAt(surface.facet(f), points);
    boxes.push_back(mesh::boxOf(points, margin));
  }
  return boxes;
}

/// Facets of a surface, their number and area.
struct Facets {
  double area = 0;
  int number = 0;
  void add(const mesh::Mesh& mesh, const mesh::Surface& surface, std::size_t facet) {
    std::vector<Point> points;
    mesh.pointsAt(surface.facet(facet), points);
    area += mesh::areaVector(surface.typeOf(facet), points).norm();
    ++number;
  }
  [[nodiscard]] double spacing(const mesh::Surface& surface) const {
    return std::pow(area / std::max(number, 1), 1.0 / dimensionOf(surface.facetType)) /
           orderOf(surface.facetType);
  }
};

/// Those that the other surface is near to, by the contact's distance.
Facets facetsNear(const mesh::Mesh& mesh, const mesh::Surface& surface, const mesh::BoxTree& other,
                  double distance) {
  const std::vector<mesh::BoxTree::Box> boxes =
      boxesOf(mesh, surface, std::isfinite(distance) ? distance : 0);
  Facets near;
  std::vector<std::size_t> found;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    if (std::isfinite(distance))
      other.meeting(boxes[f], found);
    if (!std::isfinite(distance) || !found.empty())
      near.add(mesh, surface, f);
  }
  return near;
}

/// Area of the facets of a side that the other one covers somewhere, by what it covers of them; 1 if nothing
/// can be said.
double beyondOf(const scene::Scene& scene, const std::vector<BodyLayout>& bodies,
                const scene::SurfaceContact& terms, int body, const std::string& surface) {
  const bool isFirst = body == terms.first;
  const BodyLayout &own = bodies[body], &other = bodies[isFirst ? terms.second : terms.first];
  const mesh::Surface ownSurface = surfaceOf(terms, own, surface),
                      facing = surfaceOf(terms, other, isFirst ? terms.secondSurface : terms.firstSurface);
  constexpr std::size_t few = 400; // of more the rim is a small part, and the integrals are not for nothing
  if (std::max(ownSurface.numFacets(), facing.numFacets()) > few)
    return 1;
  const contact::NodePoints here = [&](GlobalOrdinal node) { return own.mesh->point(node); },
                            there = [&](GlobalOrdinal node) { return other.mesh->point(node); };
  contact::ContactTerms asked{
      terms.name, surface,       dimensionOf(own.mesh->cellType()), componentsOf(scene.bodies[body].physics),
      terms.gap,  terms.distance};
  asked.isOfRevolution = scene.bodies[body].physics == fem::Physics::axisymmetric;
  double whole = 0, covered = 0;
  try {
    for (const contact::MortarFacet& facet :
         contact::mortarIntegrals(asked, {ownSurface, here}, {facing, there})) {
      whole += facet.whole;
      covered += facet.area;
    }
  } catch (const InputError&) { // told where the rows are made
    return 1;
  }
  return whole / covered;
}

} // namespace

double spacingOf(const mesh::Mesh& mesh, const mesh::Surface& surface) {
  Facets all;
  for (std::size_t f = 0; f < surface.numFacets(); ++f)
    all.add(mesh, surface, f);
  return all.spacing(surface);
}

mesh::Surface surfaceOf(const scene::SurfaceContact& contact, const BodyLayout& body,
                        const std::string& surface) {
  const std::vector<std::string> names = body.mesh->surfaceNames();
  if (!surface.empty() && std::find(names.begin(), names.end(), surface) == names.end()) {
    std::string known;
    for (const std::string& name : names)
      known += (known.empty() ? "'" : ", '") + name + "'";
    throw InputError("contact '" + contact.name + "': body '" + body.name + "' has no surface '" + surface +
                     "'; " + (known.empty() ? "its mesh names none" : "there are " + known));
  }
  return body.mesh->surface(surface);
}

Eigen::Vector3d areaVectorOf(const mesh::Mesh& mesh, const mesh::Surface& surface) {
  Eigen::Vector3d sum(0, 0, 0);
  std::vector<Point> points;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    mesh.pointsAt(surface.facet(f), points);
    sum += mesh::areaVector(surface.typeOf(f), points);
  }
  return sum;
}

std::string chooseSide(const scene::Scene& scene, const std::vector<BodyLayout>& bodies,
                       scene::SurfaceContact& terms) {
  const auto support = [&](int body, const std::string& surface) { // what one holds fixes no pressure
    const auto& supports = scene.bodies[body].supports;
    return std::any_of(supports.begin(), supports.end(),
                       [&](const fem::SolidSupport& held) { return held.surface == surface; })
               ? 1.0
               : 0.0;
  };
  const auto others = [&](int body, const std::string& surface) {
    std::ptrdiff_t count = -1; // itself
    for (const scene::SurfaceContact& other : scene.contacts)
      count += (other.first == body && other.firstSurface == surface) ||
                       (other.second == body && other.secondSurface == surface)
                   ? 1
                   : 0;
    return static_cast<double>(count);
  };
  const auto spacing = [&](int body, const std::string& surface) {
    const bool isFirst = body == terms.first;
    const BodyLayout &own = bodies[body], &other = bodies[isFirst ? terms.second : terms.first];
    const mesh::Surface facing = surfaceOf(terms, other, isFirst ? terms.secondSurface : terms.firstSurface);
    const mesh::Surface at = surfaceOf(terms, own, surface);
    return facetsNear(*own.mesh, at, mesh::BoxTree(boxesOf(*other.mesh, facing, 0)), terms.distance)
        .spacing(at);
  };
  const auto beyond = [&](int body,
                          const std::string& surface) { // area of its facets by what is covered of them
    return beyondOf(scene, bodies, terms, body, surface);
  };
  const auto stiffness = [&](int body, const std::string&) {
    const scene::Body& owner = scene.bodies[body];
    return owner.physics == fem::Physics::membrane ? owner.material.conductivity
                                                   : fem::meanModuli(owner.material).youngsModulus;
  };
  const auto decides = [&](const auto& measure, double margin) {
    const double first = measure(terms.first, terms.firstSurface),
                 second = measure(terms.second, terms.secondSurface);
    terms.multipliers =
        second < first ? scene::SurfaceContact::Side::second : scene::SurfaceContact::Side::first;
    return std::max(first, second) > margin * std::min(first, second);
  };
  if (decides(support, 1))
    return ", which no support holds there";
  if (decides(others, 1))
    return ", which has no other contact there";
  if (decides(spacing, 1.5))
    return ", the finer one";
  if (decides(beyond, 1.05)) // of few facets rows of those covered in part do not reach the rim
    return ", which the other one covers";
  if (decides(stiffness, 1.01)) // of meshes about as fine its pressure is the smoother one
    return ", the softer one";
  if (decides(spacing, 1.01))
    return ", the finer one";
  terms.multipliers = scene::SurfaceContact::Side::first;
  return ", the first one";
}

} // namespace epafi::model
