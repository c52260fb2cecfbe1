#include "epafi/scene/GapConsistency.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace epafi::scene {
namespace {

/// u_to − u_from ≤ bound, because of a contact pair or of a body's support.
struct Constraint {
  int from, to;
  double bound;
  int pair, body; ///< one of them, the other is −1
};

/// Corners of an edge, in the order in which edges run: 0 lower left, 1 lower right, 2 upper left, 3 upper
/// right.
std::array<int, 2> cornersOf(const std::string& edge) {
  if (edge == "left")
    return {0, 2};
  if (edge == "right")
    return {1, 3};
  return edge == "bottom" ? std::array{0, 1} : std::array{2, 3};
}

int nodeOf(int body, int corner) {
  return 4 * body + corner;
}

/// All of them; the last node is the ground, u = 0.
std::vector<Constraint> constraintsOf(const Scene& scene) {
  const int ground = nodeOf(static_cast<int>(scene.bodies.size()), 0);
  std::vector<Constraint> constraints;
  for (int b = 0; b < std::ssize(scene.bodies); ++b)
    if (isMembraneOnRectangle(scene.bodies[b]))
      for (const fem::SolidSupport& support : scene.bodies[b].supports)
        for (const int corner : cornersOf(support.surface)) {
          const double value = support.value[0].value_or(0);
          constraints.push_back({ground, nodeOf(b, corner), value, -1, b});
          constraints.push_back({nodeOf(b, corner), ground, -value, -1, b});
        }
  for (int p = 0; p < std::ssize(scene.contacts); ++p) {
    const SurfaceContact& pair = scene.contacts[p];
    if (!isAlongEdges(scene, pair))
      continue;
    for (std::size_t end = 0; end < 2; ++end)
      constraints.push_back({nodeOf(pair.second, cornersOf(pair.secondSurface)[end]),
                             nodeOf(pair.first, cornersOf(pair.firstSurface)[end]), pair.gap, p, -1});
  }
  return constraints;
}

/// A cycle of constraints whose bounds have a negative sum beyond round-off; empty if there is none.
std::vector<Constraint> negativeCycle(const std::vector<Constraint>& constraints, int numNodes) {
  double largest = 0;
  for (const Constraint& constraint : constraints)
    largest = std::max(largest, std::abs(constraint.bound));
  std::vector<double> value(numNodes, 0.0);
  std::vector<const Constraint*> last(numNodes, nullptr);
  const Constraint* tightened = nullptr;
  for (int round = 0; round <= numNodes; ++round) {
    tightened = nullptr;
    for (const Constraint& constraint : constraints) {
      const double bound = value[constraint.from] + constraint.bound;
      double& current = value[constraint.to];
      if (bound < current - 1e-12 * largest) {
        current = bound;
        last[constraint.to] = &constraint;
        tightened = &constraint;
      }
    }
    if (tightened == nullptr)
      return {};
  }
  for (int step = 0; step < numNodes; ++step) // back until we are on the cycle
    tightened = last[tightened->from];
  std::vector<Constraint> cycle;
  const Constraint* const first = tightened;
  do {
    cycle.push_back(*tightened);
    tightened = last[tightened->from];
  } while (tightened != first);
  return cycle;
}

/// "'a', 'b' and 'c'", each once.
std::string listedOnce(std::vector<std::string> names) {
  sortUnique(names);
  return listed(names, "'");
}

std::string placeOf(const Scene& scene, int node) {
  const mesh::Box& box = scene.bodies[node / 4].mesh.box;
  const int corner = node % 4;
  return '(' + valueText((corner % 2 == 0 ? box.lower : box.upper)[0]) + ", " +
         valueText((corner < 2 ? box.lower : box.upper)[1]) + ')';
}

} // namespace

void requireConsistentGaps(const Scene& scene) {
  const int numNodes = nodeOf(static_cast<int>(scene.bodies.size()), 0) + 1;
  const std::vector<Constraint> cycle = negativeCycle(constraintsOf(scene), numNodes);
  if (cycle.empty())
    return;
  std::vector<std::string> pairs, bodies;
  std::string place;
  double sum = 0;
  for (const Constraint& constraint : cycle) {
    sum += constraint.bound;
    if (constraint.pair >= 0) {
      pairs.push_back(scene.contacts[constraint.pair].name);
      place = placeOf(scene, constraint.to);
    } else {
      bodies.push_back(scene.bodies[constraint.body].name);
    }
  }
  std::ostringstream text;
  std::sort(pairs.begin(), pairs.end());
  const bool isOne = pairs.front() == pairs.back();
  text << "no solution: the " << (isOne ? "gap of the contact pair " : "gaps of the contact pairs ")
       << listedOnce(pairs);
  if (!bodies.empty())
    text << " and the supports of " << listedOnce(bodies);
  text << " contradict each other, nodes overlap by " << -sum << " at " << place
       << "; change a gap or a support";
  throw SolvabilityError(SolvabilityError::Kind::noSolution, text.str());
}

} // namespace epafi::scene
