#include "epafi/accuracy/ContactPressure.hpp"

#include "epafi/base/Errors.hpp"

#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

namespace epafi::accuracy {
namespace {

using contact::ContactLayout;

[[noreturn]] void refuse(const ContactLayout& contact, const std::string& why) {
  throw InputError("guaranteed bounds are not there for " + why + ", as contact '" + contact.name +
                   "' has; leave out \"Bound\"");
}

void requireCovered(const scene::SurfaceContact& terms, const ContactLayout& contact) {
  if (terms.coversBody())
    refuse(contact, "obstacles under membranes");
  if (terms.hasFriction())
    refuse(contact, "friction");
  if (terms.stiffness > 0)
    refuse(contact, "surfaces that give way");
  const auto isPair = [](const auto& nodes) { return nodes.size() == 1 && nodes[0].weight == 1; };
  if (!contact.firstShares.empty() || !contact.secondLevers.empty() ||
      (contact.secondBody >= 0 &&
       !std::all_of(contact.secondNodes.begin(), contact.secondNodes.end(), isPair)))
    refuse(contact, "surfaces that are coupled otherwise than node by node");
}

/// The facets of surfaces of a mesh.
template <class Action>
void forEachFacet(const mesh::Mesh& mesh, const std::vector<std::string>& names, const Action& action) {
  for (const std::string& name : names) {
    const mesh::Surface surface = mesh.surface(name);
    for (std::size_t f = 0; f < surface.numFacets(); ++f)
      action(surface.typeOf(f), surface.facet(f));
  }
}

} // namespace

ContactPressure::ContactPressure(const scene::Scene& scene, const model::Decomposition& decomposition)
    : gaps_(decomposition.problem.numInequalities, 0.0), ofNodes_(gaps_.size()), ofRows_(gaps_.size()) {
  if (!decomposition.ties.empty() || !decomposition.equations.empty() || !scene.equations.empty())
    throw InputError("guaranteed bounds are not there for tied joints, equations and springs; leave out "
                     "\"Bound\"");
  for (const ContactLayout& contact : decomposition.contacts) {
    requireCovered(scene.contacts[contact.number], contact);
    if (contact.hasOwnRows)
      addContact(contact, decomposition);
  }
}

void ContactPressure::addContact(const ContactLayout& contact, const model::Decomposition& decomposition) {
  constexpr double alike = 1e-9;
  const bool isTwoSided = contact.secondBody >= 0;
  std::unordered_map<GlobalOrdinal, std::size_t> placeOf;
  for (std::size_t place = 0; place < contact.firstNodes.size(); ++place) {
    const std::size_t row = contact.firstRow + place;
    placeOf.emplace(contact.firstNodes[place], place);
    gaps_[row] = contact.gaps[place];
    contact.forEachShare(place, [&](std::size_t node, double weight) {
      ofNodes_[contact.firstRow + node].emplace_back(row, weight);
    });
    if (contact.combinations.empty())
      ofRows_[row].emplace_back(row, 1.0);
    else
      for (const ContactLayout::Share& share : contact.smoothed[place])
        ofRows_[row].emplace_back(contact.firstRow + share.node, share.weight);
  }
  std::set<std::pair<mesh::CellType, FacetKey>> facing;
  if (isTwoSided)
    forEachFacet(
        *decomposition.bodies[contact.secondBody].mesh, contact.secondSurfaces,
        [&](mesh::CellType type, const auto& nodes) { facing.emplace(type, facetKey(type, nodes)); });
  const mesh::Mesh& mesh = *decomposition.bodies[contact.firstBody].mesh;
  std::vector<Point> points;
  forEachFacet(mesh, contact.firstSurfaces, [&](mesh::CellType type, const auto& nodes) {
    if (!std::all_of(nodes.begin(), nodes.end(), [&](GlobalOrdinal n) { return placeOf.contains(n); }))
      return;
    ContactFacet facet{
        type, contact.firstBody, contact.secondBody, {}, {nodes.begin(), nodes.end()}, {}, {}, 0, {}};
    for (const GlobalOrdinal node : nodes) {
      const std::size_t place = placeOf.at(node);
      const Eigen::VectorXd direction =
          contact.directionAt(place).head(static_cast<Eigen::Index>(contact.numComponents()));
      if (facet.rows.empty())
        facet.direction = direction;
      else if ((direction - facet.direction).norm() > alike)
        refuse(contact, "surfaces that are bent");
      facet.rows.push_back(contact.firstRow + static_cast<GlobalOrdinal>(place));
      if (isTwoSided)
        facet.facing.push_back(contact.secondNodes[place][0].node);
    }
    if (isTwoSided && !facing.contains({type, facetKey(type, facet.facing)}))
      return;
    mesh.pointsAt(nodes, points);
    facet.measure = mesh::areaVector(type, points).norm();
    facet.pressure = Eigen::VectorXd::Zero(std::ssize(nodes));
    facets_.push_back(std::move(facet));
  });
}

std::vector<double> ContactPressure::combined(const std::vector<Shares>& shares,
                                              std::span<const double> values) {
  std::vector<double> sums(values.size(), 0.0);
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (const auto& [place, weight] : shares[i])
      sums[i] += weight * values[place];
  return sums;
}

/// Continuous, with ∫ p N_j = λ_j at nodes j as far as coefficients ≥ 0 allow: complementary to
/// Σ_j β_i(x_j) (∫ p N_j − λ_j), by projected Gauss-Seidel. Of Bernstein's functions that is the least
/// ½∫p² − Σ λ p. What forces it amounts to need not be λ.
std::vector<double> ContactPressure::fit(std::span<const double> forces) {
  constexpr int sweeps = 100;
  const std::vector<double> nodal = combined(ofNodes_, forces);
  std::vector<double> wanted(forces.size(), 0.0), p(forces.size(), 0.0), measures(forces.size(), 0.0);
  std::vector<std::map<GlobalOrdinal, double>> rows(forces.size());
  for (const ContactFacet& facet : facets_)
    for (const GlobalOrdinal row : facet.rows)
      measures[row] += facet.measure;
  for (const ContactFacet& facet : facets_) {
    const fem::FacetFunctions& functions = facet.functions();
    const Eigen::MatrixXd products = facet.measure * functions.atNodes.transpose() * functions.moments;
    const std::size_t number = facet.rows.size();
    for (std::size_t i = 0; i < number; ++i)
      for (std::size_t j = 0; j < number; ++j) {
        rows[facet.rows[i]][facet.rows[j]] += products(i, j);
        // Σ λ p(x): a node's share that this facet has of what the function of i is at j
        wanted[facet.rows[i]] +=
            facet.measure / measures[facet.rows[j]] * functions.atNodes(j, i) * nodal[facet.rows[j]];
      }
  }
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t row = 0; row < forces.size(); ++row) {
      if (rows[row].empty())
        continue;
      double rest = wanted[row], own = 0;
      for (const auto& [column, value] : rows[row]) {
        rest -= value * p[column];
        if (column == static_cast<GlobalOrdinal>(row))
          own = value;
      }
      p[row] = std::max(0.0, p[row] + rest / own);
    }
  std::vector<double> result(forces.size(), 0.0);
  for (ContactFacet& facet : facets_) {
    for (std::size_t i = 0; i < facet.rows.size(); ++i)
      facet.pressure[static_cast<Eigen::Index>(i)] = p[facet.rows[i]];
    const Eigen::VectorXd moments = facet.moments();
    for (std::size_t i = 0; i < facet.rows.size(); ++i)
      result[facet.rows[i]] += moments[static_cast<Eigen::Index>(i)];
  }
  return combined(ofRows_, result);
}

void ContactPressure::addTo(std::vector<BoundLoads>& loads) const {
  for (const ContactFacet& facet : facets_) {
    const Eigen::MatrixXd forces = facet.direction * facet.moments().transpose();
    addForces(loads[facet.first].facets, facet.type, facet.nodes, -forces);
    if (facet.second >= 0)
      addForces(loads[facet.second].facets, facet.type, facet.facing, forces);
  }
}

double ContactPressure::work(std::span<const double> slack) const {
  double sum = 0;
  for (const ContactFacet& facet : facets_) {
    const Eigen::VectorXd moments = facet.moments();
    for (std::size_t i = 0; i < facet.rows.size(); ++i)
      sum += moments[static_cast<Eigen::Index>(i)] * slack[facet.rows[i]];
  }
  return sum;
}

/// At corners what they penetrate by. Between corners a and b a quadratic has the coefficient m in terms of
/// Bernstein's polynomials, which is to be no less than −s√(ab): s = 1 suffices on an edge, ½ on triangles,
/// where the quadratic is then a semidefinite form of √a …; on quadrilaterals no coefficient is to be
/// negative.
std::vector<double> ContactPressure::lacking(std::span<const double> slack) const {
  std::vector<double> lack(slack.size(), 0.0);
  for (const ContactFacet& facet : facets_)
    for (int i = 0; i < numCornersOf(facet.type); ++i)
      lack[facet.rows[i]] = std::max(0.0, -slack[facet.rows[i]]);
  const auto at = [&](GlobalOrdinal row) { return slack[row] + lack[row]; };
  for (const ContactFacet& facet : facets_) {
    const int corners = numCornersOf(facet.type);
    const double share = corners == 2 ? 1 : corners == 3 ? 0.5 : 0;
    const auto ends = edgesOf(facet.type);
    for (std::size_t middle = corners, end = 0; middle < facet.rows.size() && end < ends.size();
         ++middle, end += 2) {
      const double a = at(facet.rows[ends[end]]), b = at(facet.rows[ends[end + 1]]),
                   least = 0.25 * (a + b) - 0.5 * share * std::sqrt(a * b);
      double& its = lack[facet.rows[middle]];
      its = std::max({0.0, its, least - slack[facet.rows[middle]]});
    }
  }
  for (const ContactFacet& facet : facets_)
    if (facet.rows.size() == 9) {
      double least = 0;
      for (std::size_t i = 0; i < 8; ++i)
        least += (i < 4 ? -0.0625 : 0.25) * at(facet.rows[i]);
      lack[facet.rows[8]] = std::max(0.0, least - slack[facet.rows[8]]);
    }
  return lack;
}

} // namespace epafi::accuracy
