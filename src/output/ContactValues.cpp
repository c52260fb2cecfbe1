#include "epafi/output/ContactValues.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Slab.hpp"
#include "epafi/simulation/FrictionResults.hpp"
#include "epafi/simulation/RowShares.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace epafi::output {
namespace {

using Eigen::Vector3d;

/// CalculiX' tangents of a surface whose counterpart has a normal.
std::array<Vector3d, 2> tangentsOf(const Vector3d& normal) {
  const Vector3d axis = 1 - std::abs(normal.x()) < 1.5231e-6 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d tangent = (axis - axis.dot(normal) * normal).normalized();
  return {tangent, normal.cross(tangent)};
}

} // namespace

std::vector<ContactValues> gatherContactValues(const simulation::SolvedScene& solved, int contact,
                                               const simulation::ContactState& state) {
  const contact::ContactLayout& layout = solved.decomposition.contacts[contact];
  const std::vector<std::size_t> own = layout.ownRows();
  const GlobalOrdinal first = evenShare(std::ssize(own), solved.comm()).first;
  std::vector<ContactValues> values;
  for (std::size_t k = 0; k < state.gap.size(); ++k)
    values.push_back({state.gap[k], 0, 0, state.pressure[k], 0, 0});
  if (layout.firstFriction >= 0) {
    const simulation::FrictionFields friction = simulation::frictionFields(solved, layout);
    // which are those of the scene's first side, where the nodes may be the second one's
    const double sign = layout.firstBody == solved.scene.contacts[layout.number].first ? 1 : -1;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::array<Vector3d, 2> tangents = tangentsOf(-layout.slidingNormalAt(own[first + k]));
      for (std::size_t t = 0; t < 2; ++t) {
        values[k][1 + t] = sign * tangents[t].dot(Vector3d::Map(&friction.slip[3 * k]));
        values[k][4 + t] = sign * tangents[t].dot(Vector3d::Map(&friction.traction[3 * k]));
      }
    }
  }
  return gatherOnFirst(solved.comm(), values);
}

TotalSlip::TotalSlip(const std::vector<simulation::NodeSlip>& slip) {
  for (const simulation::NodeSlip& node : slip)
    earlier_[{node.contact, node.body, node.node}] = node.slip;
}

void TotalSlip::enter(const simulation::SolvedScene& solved, int contact,
                      std::vector<ContactValues>& values) {
  const contact::ContactLayout& layout = solved.decomposition.contacts[contact];
  const double slope = solved.scene.contacts[layout.number].stickSlope;
  const std::vector<std::size_t> own = layout.ownRows();
  constexpr std::size_t slip = 1, traction = 4;
  const auto keyOf = [&layout](std::size_t row) {
    return Key{layout.number, layout.firstBody, layout.firstNodes[row]};
  };
  const simulation::RowShares shares =
      earlier_.empty() ? simulation::RowShares() : simulation::sharesOfSlacks(layout);
  const auto earlierAt = [&](std::size_t row) {
    Vector3d sum = Vector3d::Zero();
    if (!earlier_.empty())
      simulation::forEachRow(shares, row, [&](std::size_t other, double weight) {
        if (const auto known = earlier_.find(keyOf(other)); known != earlier_.end())
          sum += weight * Vector3d::Map(known->second.data());
      });
    const std::array<Vector3d, 2> tangents = tangentsOf(-layout.slidingNormalAt(row));
    return std::array{tangents[0].dot(sum), tangents[1].dot(sum)};
  };
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Key key = keyOf(own[k]);
    if (!slipped_.contains(key))
      slipped_[key] = earlierAt(own[k]);
    std::array<double, 2>& total = slipped_[key];
    for (std::size_t t = 0; t < 2; ++t) {
      total[t] += values[k][slip + t];
      values[k][slip + t] = total[t] + (slope > 0 ? values[k][traction + t] / slope : 0);
    }
  }
}

} // namespace epafi::output
