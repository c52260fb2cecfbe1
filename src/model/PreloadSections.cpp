#include "epafi/model/PreloadSections.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/model/ContactSurfaces.hpp"
#include "epafi/model/SceneEquations.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace epafi::model {
namespace {

using contact::ContactLayout;
using contact::Equation;
using Eigen::Vector3d;

/// Round-off of directions and weights.
constexpr double negligible = 1e-12;

/// The section's normal, of length 1, out of the body whose nodes have the rows.
Vector3d normalOf(const scene::SurfaceContact& terms, const ContactLayout& layout,
                  const std::vector<std::unique_ptr<fem::BodyModel>>& models) {
  Vector3d normal(0, 0, 0);
  if (terms.preloadDirection) {
    normal = (layout.firstBody == terms.first ? 1 : -1) * Vector3d(terms.preloadDirection->data());
  } else {
    const mesh::Mesh& mesh = models[layout.firstBody]->mesh();
    normal = areaVectorOf(mesh, mesh.surface(layout.firstSurface));
  }
  if (!(normal.norm() > 0))
    throw InputError("the section " + inQuotes(terms.name) +
                     " of a bolt has no mean normal; give its Preload Direction");
  return normal.normalized();
}

using Directions = std::map<std::pair<int, GlobalOrdinal>, Vector3d>; ///< by body and node

Equation equationOf(const Directions& terms, const std::string& name) {
  Equation result{{}, 0, name};
  for (const auto& [at, direction] : terms)
    if (direction.norm() > negligible)
      result.terms.push_back({at.first, at.second, direction});
  return result;
}

/// Row of a place of a joint: Σ directionᵀu over its nodes.
Equation rowOf(const ContactLayout& layout, std::size_t place) {
  Directions terms;
  const auto add = [&](int body, GlobalOrdinal node, const Vector3d& direction) {
    terms.try_emplace({body, node}, Vector3d::Zero()).first->second += direction;
  };
  layout.forEachShare(place, [&](std::size_t node, double weight) {
    const Vector3d direction = weight * layout.directionAt(node);
    layout.forEachFirst(node, [&](const contact::NodeShare& share) {
      add(layout.firstBody, share.node, share.weight * direction);
    });
    for (const contact::NodeShare& share : layout.secondNodes[node])
      add(layout.secondBody, share.node, -share.weight * direction);
  });
  if (!layout.secondLevers.empty())
    for (const contact::NodeForce& lever : layout.secondLevers[place])
      add(layout.secondBody, lever.node, -lever.force);
  return equationOf(terms, "preload of '" + layout.name + "'");
}

/// By what a row changes as the bolt is shortened by 1: all of the first side moves along its normal.
double shareOf(const Equation& row, int firstBody, const Vector3d& normal) {
  double share = 0;
  for (const Equation::Term& term : row.terms)
    if (term.body == firstBody)
      share += term.direction.dot(normal);
  return std::abs(share) > negligible ? share : 0;
}

/// row − factor · other
Equation without(const Equation& row, double factor, const Equation& other) {
  Directions terms;
  for (const Equation::Term& term : row.terms)
    terms[{term.body, term.node}] = term.direction;
  for (const Equation::Term& term : other.terms)
    terms.try_emplace({term.body, term.node}, Vector3d::Zero()).first->second -= factor * term.direction;
  return equationOf(terms, row.name);
}

} // namespace

PreloadSection addSection(const scene::Scene& scene, const ContactLayout& layout,
                          const std::vector<std::unique_ptr<fem::BodyModel>>& models,
                          std::vector<Equation>& equations) {
  const scene::SurfaceContact& terms = scene.contacts[layout.number];
  const Vector3d normal = normalOf(terms, layout, models);
  PreloadSection section;
  section.name = terms.name;
  section.number = layout.number;
  section.firstEquation = std::ssize(equations);
  std::vector<Equation> rows;
  std::vector<double> shares;
  std::size_t pilot = layout.firstNodes.size();
  for (std::size_t place = 0; place < layout.firstNodes.size(); ++place) {
    rows.push_back(rowOf(layout, place));
    shares.push_back(shareOf(rows[place], layout.firstBody, normal));
    rows[place].value = shares[place] * (terms.preload->holdsLength() ? terms.preload->value : 0);
    if (shares[place] != 0 && !isFixed(rows[place], models) &&
        (pilot == layout.firstNodes.size() || std::abs(shares[place]) > 1.5 * std::abs(shares[pilot])))
      pilot = place;
  }
  if (pilot == rows.size())
    throw InputError("the section " + inQuotes(terms.name) +
                     " of a bolt has no node that its preload could move; release a support of its sides");
  section.pilot = rows[pilot];
  section.pilotShare = shares[pilot];
  for (std::size_t place = 0; place < rows.size(); ++place) {
    if (!terms.preload->holdsLength()) {
      if (place == pilot)
        continue;
      rows[place] = without(rows[place], shares[place] / shares[pilot], section.pilot);
    }
    if (isFixed(rows[place], models))
      continue;
    section.shares.push_back(terms.preload->holdsLength() ? shares[place] : 0);
    equations.push_back(std::move(rows[place]));
  }
  if (!terms.preload->holdsLength())
    for (const Equation::Term& term : section.pilot.terms)
      models[term.body]->addForce(term.node, terms.preload->value / section.pilotShare * term.direction);
  return section;
}

} // namespace epafi::model
