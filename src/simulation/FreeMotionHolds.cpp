#include "epafi/simulation/FreeMotionHolds.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/fetidp/equilibrium/Solvability.hpp"
#include "epafi/model/ContactData.hpp"
#include "epafi/simulation/RunResult.hpp"

#include <Eigen/Geometry>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace epafi::simulation {
namespace {

using Eigen::Vector3d;

/// A motion of some bodies: x moves by slide + turn × x.
struct Motion {
  std::map<int, std::pair<Vector3d, Vector3d>> bodies;

  explicit Motion(const fetidp::FreeMotion& motion) {
    for (const auto& [body, centre, slide, turn] : motion.bodies)
      bodies[body] = {slide - turn.cross(centre), turn};
  }
  [[nodiscard]] Vector3d at(int body, const Vector3d& x) const {
    const auto own = bodies.find(body);
    return own == bodies.end() ? Vector3d(Vector3d::Zero())
                               : Vector3d(own->second.first + own->second.second.cross(x));
  }
  void add(double factor, const Motion& other) {
    for (const auto& [body, part] : other.bodies) {
      auto& own = bodies.try_emplace(body, Vector3d::Zero(), Vector3d::Zero()).first->second;
      own.first += factor * part.first;
      own.second += factor * part.second;
    }
  }
};

/// A node and how far it moves.
struct Moved {
  double length = -1;
  int body = 0;
  GlobalOrdinal node = 0;
  Point place{};

  /// The farthest one, and of several the first.
  [[nodiscard]] bool isBefore(const Moved& other) const {
    return length != other.length ? length > other.length
                                  : std::pair(body, node) < std::pair(other.body, other.node);
  }
};

/// That moves most. Collective.
Moved farthest(const model::Decomposition& cut, const Motion& motion) {
  Moved best;
  for (const decomposition::Subdomain& part : cut.problem.subdomains)
    if (motion.bodies.contains(part.body))
      for (const GlobalOrdinal node : part.nodes) {
        const Point at = cut.bodies[part.body].mesh->point(node);
        const Moved moved{motion.at(part.body, Vector3d(at.data())).norm(), part.body, node, at};
        if (moved.isBefore(best))
          best = moved;
      }
  const std::vector<Moved> all = gatherOnAll(*cut.problem.comm, std::array{best});
  return *std::min_element(all.begin(), all.end(),
                           [](const Moved& a, const Moved& b) { return a.isBefore(b); });
}

/// Against all of the motions; false where they are not known. Collective.
bool addHolds(const model::Decomposition& cut, const std::vector<fetidp::FreeMotion>& motions,
              scene::Scene& scene) {
  constexpr std::size_t most = 6; // of a body
  if (scene.holds.size() > most * scene.bodies.size() || motions.empty() ||
      std::any_of(motions.begin(), motions.end(), [](const auto& motion) { return motion.bodies.empty(); }))
    return false;
  std::vector<Motion> left(motions.begin(), motions.end());
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const Moved held = farthest(cut, left[k]);
    const Vector3d place(held.place.data()), direction = left[k].at(held.body, place).normalized();
    scene.holds.push_back(
        {held.body, held.place, {direction[0], direction[1], direction[2]}, motions[k].words});
    for (std::size_t later = k + 1; later < motions.size(); ++later) // does not move that node
      left[later].add(-direction.dot(left[later].at(held.body, place)) / held.length, left[k]);
  }
  return true;
}

/// Of contacts; where there are none, as large as the work along the way takes.
double sizeOfForces(const RunResult& result) {
  double way = 0;
  for (const BodyResult& body : result.bodies)
    way = std::max(way, body.largestDisplacement);
  const double work = std::abs(result.energy) + std::abs(result.loadWork);
  return std::max(result.contactForce, way > 0 ? work / way : 0);
}

} // namespace

void holdFreeMotions(scene::Scene& scene, std::unique_ptr<model::Decomposition>& cut) {
  const RCP<const Comm> comm = cut->problem.comm;
  const auto isFree = [&] {
    try {
      fetidp::requireUniqueSolution(cut->problem, cut->data, fetidp::kernelConstraint(cut->problem));
    } catch (const fetidp::FreeMotionError& error) { // on all ranks
      if (!addHolds(*cut, error.motions(), scene))
        throw;
      return true;
    } catch (const SolvabilityError&) { // which is said where it is looked for
    }
    return false;
  };
  while (isFree()) {
    std::vector<model::BodyLayout> bodies = std::move(cut->bodies);
    cut = std::make_unique<model::Decomposition>(model::decompose(scene, std::move(bodies), comm));
  }
}

std::vector<HoldResult> holdResults(const SolvedScene& solved) {
  const model::Decomposition& cut = solved.decomposition;
  const GlobalOrdinal first = model::firstEquation(cut.ties, cut.problem);
  const auto multiplier = solved.solution.multiplier->getData();
  std::vector<HoldResult> results;
  for (const scene::Hold& hold : solved.scene.holds) {
    const auto found = std::find_if(cut.equations.begin(), cut.equations.end(),
                                    [&](const auto& each) { return each.name == "hold: " + hold.motion; });
    if (found == cut.equations.end()) // a support holds it
      continue;
    const LocalOrdinal row =
        cut.problem.multiplierMap->getLocalElement(first + (found - cut.equations.begin()));
    std::array<AccurateSum, 1> force;
    if (row >= 0)
      force[0].add(-multiplier[row]);
    sumOverRanks(solved.comm(), force);
    const double size = force[0].value();
    const auto& [x, y, z] = hold.direction;
    results.push_back({hold.motion, {size * x, size * y, size * z}, hold.place});
  }
  return results;
}

std::string loadedHolds(const RunResult& result) {
  constexpr double noise = 0.01;
  const double forces = sizeOfForces(result);
  for (const HoldResult& hold : result.holds)
    if (const double size = Vector3d(hold.force.data()).norm(); size > noise * forces)
      return "what holds free motions takes a force of " + text(size, 3) + " (" + hold.motion +
             "): loads turn or push it there, and with another hold the solution would be another one";
  return {};
}

} // namespace epafi::simulation
