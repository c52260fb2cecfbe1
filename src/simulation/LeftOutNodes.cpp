#include "epafi/simulation/LeftOutNodes.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/model/SceneContacts.hpp"
#include "epafi/simulation/Evaluation.hpp"
#include "epafi/simulation/PreloadResults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace epafi::simulation {
namespace {

using contact::ContactLayout;
using Eigen::Vector3d;

/// An overlap beside what the sides have moved that is more than the iteration's error.
constexpr double clearly = 1e-4;

/// How far the sides of contacts move at most, bodies being asked once each.
class Motions {
public:
  explicit Motions(const SolvedScene& solved) : solved_(solved) {} ///< keeps a reference
  /// Collective.
  [[nodiscard]] double of(const scene::SurfaceContact& contact) {
    return ofBody(contact.first) + (contact.second >= 0 ? ofBody(contact.second) : 0);
  }

private:
  [[nodiscard]] double ofBody(int body) {
    const auto [entry, isNew] = known_.try_emplace(body, 0.0);
    if (isNew)
      entry->second = largestDisplacement(solved_, body);
    return entry->second;
  }

  const SolvedScene& solved_;
  std::map<int, double> known_;
};

/// The scene without the distances of contacts whose sides move beyond it; none: there is no such contact.
/// Collective.
std::optional<scene::Scene> withoutDistances(const SolvedScene& solved, Motions& motions) {
  std::optional<scene::Scene> result;
  for (const ContactLayout& layout : solved.decomposition.contacts) {
    const scene::SurfaceContact& asked = solved.scene.contacts[layout.number];
    const bool isAlongCurves = asked.second >= 0 && solved.decomposition.problem.components == 1;
    if (!std::isfinite(asked.distance) || isAlongCurves || // where membranes deflect across what is apart
        asked.distance + std::min(asked.gap, 0.0) >= motions.of(asked))
      continue;
    if (!result)
      result = solved.scene;
    scene::SurfaceContact& contact = result->contacts[layout.number];
    contact.distance = std::numeric_limits<double>::infinity();
    if (!layout.firstShares.empty()) // by mortars, whose multipliers stay where they are
      contact.multipliers = layout.firstBody == asked.first ? scene::SurfaceContact::Side::first
                                                            : scene::SurfaceContact::Side::second;
  }
  return result;
}

/// The rows of contacts, laid out anew. Collective.
std::vector<ContactLayout> layOut(const scene::Scene& scene, const SolvedScene& solved) {
  std::vector<ContactLayout> contacts;
  collectively(solved.comm(), [&] {
    std::vector<std::unique_ptr<fem::BodyModel>> models;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      models.push_back(model::makeModel(scene.bodies[b], *solved.decomposition.bodies[b].mesh));
    contacts =
        model::layoutContacts(scene, solved.decomposition.bodies, model::supportedNodes(models)).contacts;
  });
  return contacts;
}

/// Of each place of a contact's nodes gap − dᵀ(u_first − u_second). Collective.
std::vector<double> slacksOf(const ContactLayout& contact, const SolvedScene& solved) {
  std::vector<double> slacks = contact.gaps;
  const auto subtract = [&](int body, double sign, const auto& forEachNode) {
    std::vector<GlobalOrdinal> nodes;
    for (std::size_t place = 0; place < slacks.size(); ++place)
      forEachNode(place, [&](const contact::NodeShare& share) { nodes.push_back(share.node); });
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const std::vector<Vector3d> u = displacementsAt(solved, body, nodes);
    for (std::size_t place = 0; place < slacks.size(); ++place)
      forEachNode(place, [&](const contact::NodeShare& share) {
        const auto at = std::lower_bound(nodes.begin(), nodes.end(), share.node) - nodes.begin();
        slacks[place] -= sign * share.weight * contact.directionAt(place).dot(u[at]);
      });
  };
  subtract(contact.firstBody, 1,
           [&](std::size_t place, const auto& action) { contact.forEachFirst(place, action); });
  if (contact.secondBody >= 0)
    subtract(contact.secondBody, -1, [&](std::size_t place, const auto& action) {
      for (const contact::NodeShare& share : contact.secondNodes[place])
        action(share);
    });
  return slacks;
}

/// What overlaps among rows that `solved` has not; empty: nothing by more than `tolerance`. Collective.
std::string overlapOf(const ContactLayout& whole, const ContactLayout& used, double tolerance, double gap,
                      const SolvedScene& solved) {
  std::vector<GlobalOrdinal> known = used.firstNodes;
  std::sort(known.begin(), known.end());
  const std::vector<double> slacks = slacksOf(whole, solved);
  double deepest = 0, farthest = 0;
  for (std::size_t row = 0; row < slacks.size(); ++row) {
    if (whole.firstBody == used.firstBody &&
        std::binary_search(known.begin(), known.end(), whole.firstNodes[row]))
      continue;
    double slack = 0, before = 0;
    whole.forEachShare(row, [&](std::size_t place, double weight) {
      slack += weight * slacks[place];
      before += weight * (whole.gaps[place] - gap);
    });
    if (slack >= -tolerance)
      continue;
    deepest = std::max(deepest, -slack);
    farthest = std::max(farthest, before);
  }
  return deepest == 0 ? ""
                      : "contact '" + used.name + "': its sides overlap by " + text(deepest, 2) +
                            " at nodes that its Distance leaves out, which are up to " + text(farthest, 3) +
                            " apart before the load; enlarge it";
}

} // namespace

std::string overlapsBeyondDistance(const SolvedScene& solved, std::string& doubt) {
  Motions motions(solved);
  const std::optional<scene::Scene> scene = withoutDistances(solved, motions);
  if (!scene)
    return "";
  std::string all;
  const auto add = [&](const std::string& sentence) {
    all += (all.empty() || sentence.empty() ? "" : "; ") + sentence;
  };
  try {
    for (const ContactLayout& whole : layOut(*scene, solved))
      for (const ContactLayout& used : solved.decomposition.contacts) {
        const scene::SurfaceContact& asked = solved.scene.contacts[used.number];
        if (used.number == whole.number && whole.hasOwnRows && std::isfinite(asked.distance) &&
            !std::isfinite(scene->contacts[used.number].distance))
          add(overlapOf(whole, used, clearly * motions.of(asked), asked.gap, solved));
      }
  } catch (const InputError& error) { // on all ranks
    doubt =
        std::string("whether nodes meet that a Distance leaves out could not be found out: ") + error.what();
  }
  return all;
}

} // namespace epafi::simulation
