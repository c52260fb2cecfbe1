#include "epafi/model/SceneEquations.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/MeshPart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace epafi::model {
namespace {

/// Supports that share a direction with an axis up to this prescribe it.
constexpr double sameDirection = 1e-9;

/// Displacement of a node along an axis, if supports prescribe it.
std::optional<double> heldAlong(const fem::BodyModel& model, GlobalOrdinal node,
                                const Eigen::Vector3d& axis) {
  const Eigen::Matrix3d* const frame = model.frame(node);
  const Eigen::Vector3d own = frame != nullptr ? Eigen::Vector3d(frame->transpose() * axis) : axis;
  double sum = 0;
  for (int c = 0; c < model.components(); ++c)
    if (std::abs(own[c]) > sameDirection) {
      const std::optional<double> value = model.prescribed(node, c);
      if (!value)
        return std::nullopt;
      sum += own[c] * *value;
    }
  return sum;
}

/// The one node of each set that equations name; a set is looked for once.
class EquationNodes {
public:
  EquationNodes(const scene::Scene& scene, const std::vector<std::unique_ptr<fem::BodyModel>>& models) {
    for (std::size_t b = 0; b < models.size(); ++b)
      bodies_.push_back(std::make_unique<fem::SolidBody>(scene.bodies[b], models[b]->mesh()));
  }
  GlobalOrdinal of(const scene::Equation& equation, const scene::Equation::Term& term) {
    const auto [place, isNew] = known_.try_emplace({term.body, term.nodes}, 0);
    if (isNew) {
      const fem::SolidBody& body = *bodies_[term.body];
      const std::vector<GlobalOrdinal> nodes = body.nodesOf(inQuotes(equation.name), term.nodes);
      if (nodes.size() != 1)
        throw body.refusal("equation " + inQuotes(equation.name) + " is about one node, but " +
                           inQuotes(term.nodes) + " has " + std::to_string(nodes.size()));
      place->second = nodes.front();
    }
    return place->second;
  }

private:
  std::vector<std::unique_ptr<fem::SolidBody>> bodies_;
  std::map<std::pair<int, std::string>, GlobalOrdinal> known_;
};

/// With terms of the size 1: rows of B are alike in size.
contact::Equation scaled(contact::Equation equation) {
  double largest = 0;
  for (const contact::Equation::Term& term : equation.terms)
    largest = std::max(largest, term.direction.norm());
  for (contact::Equation::Term& term : equation.terms)
    term.direction /= largest;
  equation.value /= largest;
  equation.stiffness *= largest * largest;
  return equation;
}

} // namespace

bool isFixed(const contact::Equation& equation, const std::vector<std::unique_ptr<fem::BodyModel>>& models) {
  double sum = -equation.value, scale = std::abs(equation.value);
  for (const contact::Equation::Term& term : equation.terms) {
    const double length = term.direction.norm();
    const auto held = heldAlong(*models[term.body], term.node, term.direction / length);
    if (!held)
      return false;
    sum += length * *held;
    scale = std::max(scale, std::abs(length * *held));
  }
  if (equation.stiffness == 0 && std::abs(sum) > 1e-10 * scale)
    throw SolvabilityError(SolvabilityError::Kind::noSolution,
                           "supports hold all displacements of the equation " + inQuotes(equation.name) +
                               ", at values that miss it by " + text(sum) + "; release one of them");
  return true;
}

std::vector<GlobalOrdinal> heldNodes(const scene::Scene& scene, const std::vector<BodyLayout>& bodies,
                                     const Comm& comm) {
  std::vector<GlobalOrdinal> nodes;
  for (const scene::Hold& hold : scene.holds) {
    const mesh::Mesh& mesh = *bodies[hold.body].mesh;
    const mesh::MeshPart* const piece = mesh.part();
    const GlobalOrdinal number = piece != nullptr ? std::ssize(piece->nodes()) : mesh.numNodes();
    double least = std::numeric_limits<double>::infinity();
    GlobalOrdinal nearest = mesh.numNodes();
    for (GlobalOrdinal k = 0; k < number; ++k) {
      const GlobalOrdinal node = piece != nullptr ? piece->nodes()[k] : k;
      const Point at = mesh.point(node);
      const double distance = std::hypot(at[0] - hold.place[0], at[1] - hold.place[1], at[2] - hold.place[2]);
      if (distance < least) {
        least = distance;
        nearest = node;
      }
    }
    const bool isNearest = least <= minOverRanks(comm, least);
    nodes.push_back(minOverRanks(comm, isNearest ? nearest : mesh.numNodes()));
  }
  return nodes;
}

std::vector<contact::Equation> equationsOf(const scene::Scene& scene,
                                           const std::vector<std::unique_ptr<fem::BodyModel>>& models,
                                           const std::vector<GlobalOrdinal>& held) {
  std::vector<contact::Equation> equations;
  EquationNodes nodes(scene, models);
  for (const scene::Equation& each : scene.equations) {
    contact::Equation equation{{}, each.value, each.name, each.stiffness};
    for (const scene::Equation::Term& term : each.terms) {
      const GlobalOrdinal node = nodes.of(each, term);
      const Eigen::Vector3d share = term.factor * Eigen::Vector3d::Unit(term.component);
      const auto same = std::find_if(equation.terms.begin(), equation.terms.end(), [&](const auto& other) {
        return other.body == term.body && other.node == node;
      });
      if (same != equation.terms.end())
        same->direction += share;
      else
        equation.terms.push_back({term.body, node, share});
    }
    std::erase_if(equation.terms, [](const auto& term) { return term.direction.isZero(0); });
    if (equation.terms.empty())
      throw InputError("the terms of the equation " + inQuotes(each.name) + " cancel; remove it");
    if (!isFixed(equation, models))
      equations.push_back(scaled(std::move(equation)));
  }
  for (std::size_t k = 0; k < held.size(); ++k) {
    const scene::Hold& hold = scene.holds[k];
    contact::Equation equation{
        {{hold.body, held[k], Eigen::Vector3d(hold.direction.data())}}, 0, "hold: " + hold.motion, 0};
    if (!isFixed(equation, models))
      equations.push_back(std::move(equation));
  }
  return equations;
}

} // namespace epafi::model
