#include "epafi/model/ContactCoupler.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/ContactSearch.hpp"
#include "epafi/contact/MortarRows.hpp"
#include "epafi/contact/QuadraticFaces.hpp"
#include "epafi/contact/RigidLinks.hpp"
#include "epafi/contact/SymmetryPlanes.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/model/ContactSurfaces.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace epafi::model {

using contact::ContactLayout;

namespace {

contact::NodePoints pointsOf(const BodyLayout& body) {
  return [mesh = body.mesh.get()](GlobalOrdinal node) { return mesh->point(node); };
}

/// Whether nodes along two edges of structured meshes meet in order.
bool haveEqualEdges(const scene::SurfaceContact& terms, const std::vector<BodyLayout>& bodies) {
  const auto numElements = [&](int body, const std::string& edge) {
    const mesh::StructuredMesh* mesh = bodies[body].mesh->structured();
    return mesh == nullptr ? 0 : mesh->elements()[edge == "left" || edge == "right" ? 1 : 0];
  };
  const auto number = numElements(terms.first, terms.firstSurface);
  return number > 0 && number == numElements(terms.second, terms.secondSurface);
}

contact::Obstacle obstacleOf(const scene::Obstacle& obstacle) {
  using Kind = contact::Obstacle::Kind;
  using Asked = scene::Obstacle::Kind;
  return {obstacle.kind == Asked::plane    ? Kind::plane
          : obstacle.kind == Asked::sphere ? Kind::sphere
                                           : Kind::cylinder,
          {obstacle.point[0], obstacle.point[1], obstacle.point[2]},
          {obstacle.normal[0], obstacle.normal[1], obstacle.normal[2]},
          obstacle.radius,
          obstacle.isHollow};
}

} // namespace

Coupler::Coupler(const ContactGroup& group, const std::vector<BodyLayout>& bodies, int components,
                 const SupportedNodes& supported, const TiedNodes* tied)
    : terms_(group.terms.front()), bodies_(bodies), components_(components), supported_(supported),
      tied_(tied), first_{terms_.first, {}}, second_{terms_.second, {}} {
  for (const scene::SurfaceContact& terms : group.terms) {
    name_ += (name_.empty() ? "" : "', '") + terms.name;
    first_.surfaces.push_back(terms.firstSurface);
    second_.surfaces.push_back(terms.secondSurface);
    if (terms.second >= 0)
      surfaceOf(terms, layoutOf(second_), terms.secondSurface); // that it is there
    surfaceOf(terms, layoutOf(first_), terms.firstSurface);
  }
  second_.isTurnedOver = isTied() && std::isfinite(terms_.distance) && faceOneWay();
}

/// Whether both surfaces look into the same direction, as where a body stands in another one.
bool Coupler::faceOneWay() const {
  const Eigen::Vector3d own = areaVectorOf(*layoutOf(first_).mesh, united(first_).surface),
                        other = areaVectorOf(*layoutOf(second_).mesh, united(second_).surface);
  constexpr double clearly = 0.7;
  return own.dot(other) > clearly * own.norm() * other.norm();
}

ContactLayout Coupler::layout() const {
  if (second_.body < 0) {
    const contact::UnitedSurface surface = united(first_);
    return finish(meetObstacle(asked(first_, surface),
                               contact::surfaceNodes(pointsOf(layoutOf(first_)), surface.surface, 0,
                                                     supported_.areOfRevolution),
                               obstacleOf(terms_.obstacle)),
                  first_, second_, "nodes of '" + layoutOf(first_).name + "'");
  }
  const bool isSpring = isTied() && terms_.stiffness > 0; // whose rows need areas
  if (terms_.coupling != scene::SurfaceContact::Coupling::mortar && !isSpring)
    if (std::optional<ContactLayout> pairs = byPairs())
      return *std::move(pairs);
  return byMortar();
}

/// Forces act on the thinner one of two plane bodies.
std::vector<double> Coupler::thicknesses(const Side& first, const mesh::Surface& surface) const {
  std::vector<double> own = supported_.thicknesses(first.body, surface);
  const Side& second = first.body == first_.body ? second_ : first_;
  if (second.body < 0 || own.empty())
    return own;
  const mesh::Surface facing = united(second).surface;
  const std::vector<double> theirs = supported_.thicknesses(second.body, facing);
  const auto middles = [&](const Side& side, const mesh::Surface& of) {
    std::vector<Eigen::Vector2d> result;
    std::vector<Point> points;
    for (std::size_t f = 0; f < of.numFacets(); ++f) {
      layoutOf(side).mesh->pointsAt(of.facet(f), points);
      const Point x = mesh::centreOf(points);
      result.emplace_back(x[0], x[1]);
    }
    return result;
  };
  const bool isUniform = std::equal(theirs.begin() + 1, theirs.end(), theirs.begin());
  const std::vector<Eigen::Vector2d> here = middles(first, surface), there = middles(second, facing);
  for (std::size_t f = 0; f < own.size(); ++f) {
    std::size_t nearest = 0;
    for (std::size_t g = 1; g < there.size() && !isUniform; ++g)
      if ((there[g] - here[f]).squaredNorm() < (there[nearest] - here[f]).squaredNorm())
        nearest = g;
    own[f] = std::min(own[f], theirs[nearest]);
  }
  return own;
}

/// Those whose gaps count as none. \param first  the side that is to have the rows
std::function<bool(GlobalOrdinal)> Coupler::adjustedNodes(const Side& first) const {
  const mesh::Mesh& mesh = *layoutOf(first).mesh;
  const std::vector<std::string> names = mesh.nodeSetNames();
  if (first.body != terms_.first || std::find(names.begin(), names.end(), terms_.adjustNodes) == names.end())
    throw InputError("contact '" + terms_.name + "': \"" + terms_.adjustNodes +
                     "\" is no set of nodes of the side that carries the multipliers, '" +
                     layoutOf(first).name + "'; name one there, or adjust gaps up to a length");
  return [nodes = mesh.nodeSet(terms_.adjustNodes)](GlobalOrdinal node) {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  };
}

/// \param first  the side that is to have the rows
contact::ContactTerms Coupler::asked(const Side& first, const contact::UnitedSurface& surface) const {
  contact::ContactTerms asked{
      name_,      first.surfaces.front(), dimensionOf(layoutOf(first).mesh->cellType()), components_,
      terms_.gap, terms_.distance};
  asked.adjust = terms_.adjust;
  if (!terms_.adjustNodes.empty())
    asked.isAdjusted = adjustedNodes(first);
  asked.isOfRevolution = supported_.areOfRevolution;
  asked.givesWay = terms_.stiffness > 0;
  asked.sense = first.body == first_.body ? 1 : -1;
  if (first.surfaces.size() > 1)
    asked.parts = surface.parts;
  if (supported_.thicknesses)
    asked.thicknesses = thicknesses(first, surface.surface);
  if (components_ > 1 && second_.body >= 0 && supported_.extent)
    asked.thickness = [this](const Eigen::Vector3d& direction) {
      return std::min(supported_.extent(first_.body, direction), supported_.extent(second_.body, direction));
    };
  return asked;
}

ContactLayout Coupler::finish(ContactLayout layout, const Side& first, const Side& second,
                              std::string means) const {
  layout.name = terms_.name;
  layout.firstBody = first.body;
  layout.firstSurface = first.surfaces.front();
  layout.firstSurfaces = first.surfaces;
  layout.secondBody = second.body;
  layout.secondSurfaces = second.surfaces;
  layout.means = std::move(means);
  if (!isTied() && components_ > 1 && second.body >= 0 && supported_.heldAxes)
    contact::findSymmetryPlanes(pointsOf(layoutOf(first)), pointsOf(layoutOf(second)), supported_.heldAxes,
                                layout);
  return layout;
}

/// Whether supports hold a side wholly in the direction of contact, so that of rows at its nodes no single
/// force is known.
bool Coupler::isHeld(const Side& side) const {
  const contact::SurfaceNodes nodes = contact::surfaceNodes(pointsOf(layoutOf(side)), united(side).surface);
  for (std::size_t k = 0; k < nodes.nodes.size(); ++k)
    if (!supported_.isHeld ||
        !supported_.isHeld(side.body, nodes.nodes[k],
                           components_ == 1 ? Eigen::Vector3d(1, 0, 0) : nodes.normals[k]))
      return false;
  return true;
}

/// Nothing if the surfaces ask for mortars.
std::optional<ContactLayout> Coupler::byPairs() const {
  bool areSwapped = orderOf(first_) < orderOf(second_); // the side with more nodes has the rows
  if (!isTied() && orderOf(first_) != orderOf(second_) &&
      isHeld(areSwapped ? second_ : first_)) // if it can move
    areSwapped = !areSwapped;
  const Side &first = areSwapped ? second_ : first_, &second = areSwapped ? first_ : second_;
  const int order = orderOf(first);
  const contact::UnitedSurface carrier = untied(first, second), faced = untied(second, first);
  contact::ContactTerms asked = this->asked(first, carrier);
  asked.coincide = components_ == 1 && order == orderOf(second) && haveEqualEdges(terms_, bodies_);
  const contact::SurfaceNodes nodes = contact::surfaceNodes(pointsOf(layoutOf(first)), carrier.surface, order,
                                                            supported_.areOfRevolution),
                              facing = contact::surfaceNodes(pointsOf(layoutOf(second)), faced.surface, order,
                                                             supported_.areOfRevolution);
  if (terms_.coupling != scene::SurfaceContact::Coupling::nodes && !areAlike(asked, nodes, facing))
    return {};
  const contact::FacingNodes pairs = facingNodes(asked, nodes, facing);
  ContactLayout layout =
      finish(isTied() ? tieSurface(asked, nodes, facing, pairs, axesOf(first, carrier.surface))
                      : meetSurface(asked, nodes, facing, pairs),
             first, second, "pairs of nodes");
  if (isTied()) {
    const contact::NodePoints own = pointsOf(layoutOf(first)), theirs = pointsOf(layoutOf(second));
    contact::linkRigidly({carrier.surface, own}, {faced.surface, theirs}, layout);
    contact::smoothRows(carrier.surface, layout);
  } else if (tied_ != nullptr) {
    tied_->dropFrom(layout);
  }
  return layout;
}

std::function<bool(GlobalOrdinal)> Coupler::tiedNodes(const Side& side, const Side& other) const {
  return isTied() || tied_ == nullptr ? nullptr : tied_->heldBetween(side.body, other.body);
}

/// The facets of a side of which not all nodes are tied.
contact::UnitedSurface Coupler::untied(const Side& side, const Side& other) const {
  contact::UnitedSurface whole = united(side);
  const std::function<bool(GlobalOrdinal)> isTiedNode = tiedNodes(side, other);
  if (!isTiedNode)
    return whole;
  contact::UnitedSurface result{{whole.surface.facetType, {}, {}}, {}};
  for (std::size_t f = 0; f < whole.surface.numFacets(); ++f) {
    const auto nodes = whole.surface.facet(f);
    if (std::all_of(nodes.begin(), nodes.end(), isTiedNode))
      continue;
    result.surface.add(nodes);
    result.surface.elements.push_back(whole.surface.elements[f]);
    result.parts.push_back(whole.parts[f]);
  }
  if (result.parts.empty())
    refuseTied(terms_.name, tied_->nameBetween(side.body, other.body));
  return result;
}

ContactLayout Coupler::byMortar() const {
  const bool areSwapped = terms_.multipliers == scene::SurfaceContact::Side::second;
  const Side &first = areSwapped ? second_ : first_, &second = areSwapped ? first_ : second_;
  const contact::UnitedSurface carrier = untied(first, second), facing = untied(second, first);
  const contact::ContactTerms asked = this->asked(first, carrier);
  const contact::NodePoints ownPoints = pointsOf(layoutOf(first)), otherPoints = pointsOf(layoutOf(second));
  const contact::PlacedSurface own{carrier.surface, ownPoints}, other{facing.surface, otherPoints};
  const auto held = [&](GlobalOrdinal node, const Eigen::Vector3d& direction) {
    return supported_.isHeld && supported_.isHeld(first.body, node, direction);
  };
  ContactLayout layout =
      finish(isTied() ? tieByMortar(asked, own, other, held, axesOf(first, carrier.surface))
                      : meetByMortar(asked, own, other, tiedNodes(first, second)),
             first, second, "mortars on '" + layoutOf(first).name + "'");
  if (isTied())
    contact::linkRigidly(own, other, layout);
  return layout;
}

} // namespace epafi::model
