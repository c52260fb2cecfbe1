#include "epafi/simulation/JointResults.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/simulation/ContactState.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace epafi::simulation {
namespace {

using contact::ContactLayout;
using Eigen::Vector3d;

Vector3d placeOf(const SolvedScene& solved, int body, GlobalOrdinal node) {
  const Point x = solved.decomposition.bodies[body].mesh->point(node);
  return {x[0], x[1], x[2]};
}

/// Sums over the rows of a layout, those of this rank until they are summed.
class JointSums {
public:
  /// \param origin  to take moments about
  JointSums(const SolvedScene& solved, const ContactLayout& layout, const Vector3d& origin)
      : solved_(solved), layout_(layout), origin_(origin) {}

  /// Takes in the force of a row.
  void add(std::size_t row, double force) {
    layout_.forEachShare(row, [&](std::size_t place, double weight) {
      const Vector3d direction = force * weight * layout_.spatialDirectionAt(place);
      layout_.forEachFirst(
          place, [&](const contact::NodeShare& share) { addAt(layout_.firstBody, share, direction, 0); });
      if (layout_.secondBody >= 0) // else an obstacle, which has no nodes
        for (const contact::NodeShare& share : layout_.secondNodes[place])
          addAt(layout_.secondBody, share, direction, 6);
    });
    if (!layout_.secondLevers.empty())
      for (const contact::NodeForce& lever : layout_.secondLevers[row])
        addAt(layout_.secondBody, {lever.node, 1}, force * lever.force, 6);
    sums_[sizes].add(std::abs(force));
  }
  /// Collective.
  void finish() {
    sumOverRanks(solved_.comm(), sums_);
    size_ = maxOverRanks(solved_.comm(), size_);
  }
  /// On the layout's first body, times −1.
  [[nodiscard]] Vector3d resultant() const {
    return solved_.isOfRevolution() ? Vector3d(0, vector(0)[1], 0) : vector(0);
  }
  [[nodiscard]] JointBalance balance() const {
    const double force = sums_[sizes].value();
    const auto relative = [](double value, double reference) {
      return reference > 0 ? value / reference : 0.0;
    };
    return {layout_.means, relative((vector(0) - vector(6)).norm(), force),
            relative((vector(3) - vector(9)).norm(), force * size_)};
  }

private:
  static constexpr std::size_t sizes = 12; ///< Σ|λ|

  void addAt(int body, const contact::NodeShare& share, const Vector3d& direction, std::size_t first) {
    const Vector3d place = placeOf(solved_, body, share.node) - origin_, force = share.weight * direction,
                   moment = place.cross(force);
    size_ = std::max(size_, place.norm());
    for (Eigen::Index d = 0; d < 3; ++d) {
      sums_[first + d].add(force[d]);
      sums_[first + 3 + d].add(moment[d]);
    }
  }
  [[nodiscard]] Vector3d vector(std::size_t first) const {
    return {sums_[first].value(), sums_[first + 1].value(), sums_[first + 2].value()};
  }

  const SolvedScene& solved_;
  const ContactLayout& layout_;
  Vector3d origin_;
  std::array<AccurateSum, sizes + 1> sums_; ///< force and moment of the first side, of the second
  double size_ = 0;                         ///< of the surface, from the origin
};

/// Sums of a layout whose rows have global numbers from `offset` + firstRow on; `each` sees a row and its
/// force. Collective.
template <class Action>
JointSums sumsOf(const SolvedScene& solved, const ContactLayout& layout, GlobalOrdinal offset,
                 const Action& each) {
  const Map& map = *solved.decomposition.problem.multiplierMap;
  const auto multiplier = solved.solution.multiplier->getData();
  JointSums sums(solved, layout, placeOf(solved, layout.firstBody, layout.firstNodes.front()));
  for (LocalOrdinal i = 0; i < multiplier.size(); ++i) {
    const GlobalOrdinal row = map.getGlobalElement(i) - offset - layout.firstRow;
    if (row < 0 || row >= layout.numRows())
      continue;
    const std::size_t place = row;
    sums.add(place, layout.portion(place) * multiplier[i]);
    each(place, multiplier[i]);
  }
  sums.finish();
  return sums;
}

/// Areas below this share of the mean are round-off: a node without neighbours in the joint, which has no
/// traction.
constexpr double roundOffOfArea = 1e-9;

using Tractions = std::map<GlobalOrdinal, Vector3d>; ///< of nodes

/// Sums of a tied joint, and the tractions on its nodes, ∫pN̂/∫N̂ (contact/QuadraticFaces.hpp): areas of
/// nodes may be 0, these are not.
struct TieForces {
  JointSums sums;
  Tractions tractions;
};

/// Collective.
TieForces forcesOf(const SolvedScene& solved, const ContactLayout& tie) {
  std::vector<double> forces(tie.firstNodes.size(), 0.0), areas = tie.areas;
  TieForces result{sumsOf(solved, tie, solved.decomposition.problem.firstTie(),
                          [&](std::size_t row, double force) { forces[row] = force; }),
                   {}};
  sumOverRanks(solved.comm(), std::span(forces)); // each is one rank's
  const double mean = std::accumulate(areas.begin(), areas.end(), 0.0) /
                      static_cast<double>(std::max<std::size_t>(1, areas.size()));
  for (const std::size_t row : tie.ownRows()) {
    double force = forces[row], area = areas[row];
    if (!tie.isDual && !tie.smoothed.empty()) {
      force = area = 0;
      for (const ContactLayout::Share& share : tie.smoothed[row]) {
        force += share.weight * forces[share.node];
        area += share.weight * areas[share.node];
      }
    }
    if (area > roundOffOfArea * mean)
      result.tractions.try_emplace(tie.firstNodes[row], Vector3d::Zero()).first->second +=
          force / area * tie.spatialDirectionAt(row);
  }
  return result;
}

} // namespace

TieFields gatherTieFields(const SolvedScene& solved, const ContactLayout& tie) {
  const Tractions traction = forcesOf(solved, tie).tractions;
  TieFields fields;
  fields.numNodes = traction.size();
  fields.nodes = evenShare(fields.numNodes, solved.comm());
  auto entry = std::next(traction.begin(), fields.nodes.first);
  for (GlobalOrdinal k = 0; k < fields.nodes.count; ++k, ++entry) {
    const Vector3d point = placeOf(solved, tie.firstBody, entry->first);
    fields.points.insert(fields.points.end(), point.begin(), point.end());
    fields.traction.insert(fields.traction.end(), entry->second.begin(), entry->second.end());
  }
  return fields;
}

ContactForce contactForce(const SolvedScene& solved, const ContactLayout& layout) {
  const Vector3d resultant = sumsOf(solved, layout, 0, [](std::size_t, double) {}).resultant();
  ContactForce force{resultant.norm(), rcp(new Vector(solved.decomposition.problem.multiplierMap))};
  if (force.value == 0)
    return force;
  const auto weights = force.weights->getDataNonConst();
  for (LocalOrdinal i = 0; i < weights.size(); ++i) {
    const GlobalOrdinal row = force.weights->getMap()->getGlobalElement(i) - layout.firstRow;
    if (row < 0 || row >= layout.numRows())
      continue;
    const double portion = layout.portion(row);
    layout.forEachShare(row, [&](std::size_t place, double weight) {
      layout.forEachFirst(place, [&](const contact::NodeShare& share) {
        weights[i] +=
            portion * weight * share.weight * layout.spatialDirectionAt(place).dot(resultant) / force.value;
      });
    });
  }
  return force;
}

JointBalance balanceOf(const SolvedScene& solved, const ContactLayout& layout) {
  return sumsOf(solved, layout, 0, [](std::size_t, double) {}).balance();
}

std::vector<TieResult> tieResults(const SolvedScene& solved) {
  std::vector<TieResult> results;
  for (const ContactLayout& layout : solved.decomposition.ties) {
    const auto [sums, tractions] = forcesOf(solved, layout);
    TieResult& result = results.emplace_back();
    result.name = layout.name;
    result.nodes = tractions.size();
    const bool areSwapped = layout.firstBody != solved.scene.contacts[layout.number].first;
    const Vector3d resultant = (areSwapped ? 1.0 : -1.0) * sums.resultant();
    result.resultant = {resultant[0], resultant[1], resultant[2]};
    for (const auto& [node, traction] : tractions)
      result.largestTraction = std::max(result.largestTraction, traction.norm());
    result.note = layout.note;
    result.balance = sums.balance();
  }
  return results;
}

} // namespace epafi::simulation
