#include "epafi/contact/MultiplierNodes.hpp"

#include "epafi/direct/DenseSymmetric.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

namespace epafi::contact {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// A node has no multiplier if less than this share of its N̂ is covered.
constexpr double leastCoverage = 1e-3;
/// Where turns are to be held, beside the node that is covered most.
constexpr double coverageOfTurns = 0.05;

} // namespace

MultiplierNodes::MultiplierNodes(const SurfaceNodes& nodes,
                                 const std::map<std::size_t, Eigen::MatrixXd>& bases,
                                 const std::vector<MortarFacet>& facets)
    : nodes_(nodes), facets_(facets) {
  std::vector<double> covered(nodes.nodes.size(), 0.0), whole = covered;
  const auto addTo = [&](std::size_t facet, const VectorXd& shares, std::vector<double>& sums) {
    const std::vector<std::size_t>& places = nodes.facets[facet].nodes;
    const VectorXd values = bases.at(places.size()) * shares;
    for (std::size_t a = 0; a < places.size(); ++a)
      sums[places[a]] += values[a];
  };
  for (std::size_t f = 0; f < nodes.facets.size(); ++f)
    addTo(f, VectorXd::Map(nodes.facets[f].shares.data(), std::ssize(nodes.facets[f].nodes)), whole);
  for (const MortarFacet& facet : facets)
    addTo(facet.facet, facet.shares, covered);
  // Of edges of order 2 that begin on the axis of a solid of revolution the first function has no integral.
  const double roundOff = 1e-12 * *std::max_element(whole.begin(), whole.end());
  for (std::size_t k = 0; k < covered.size(); ++k)
    coverage_.push_back(whole[k] > roundOff ? covered[k] / whole[k] : 0);
}

std::vector<std::size_t> MultiplierNodes::representatives(const std::function<bool(std::size_t)>& isHeld,
                                                          bool holdTurns) const {
  std::vector<std::size_t> representative(nodes_.nodes.size(), none);
  for (const MortarFacet& facet : facets_) {
    const std::vector<std::size_t>& places = nodes_.facets[facet.facet].nodes;
    for (std::size_t a = 0; a < places.size(); ++a)
      if (facet.isReached[a] != 0 && coverage_[places[a]] >= leastCoverage && !isHeld(places[a]))
        representative[places[a]] = places[a];
  }
  spread(representative);
  for (const MortarFacet& facet : facets_) { // where less than a facet is covered, no node may be reached
    const std::vector<std::size_t>& places = nodes_.facets[facet.facet].nodes;
    std::size_t best = none;
    for (const std::size_t k : places)
      if (!isHeld(k) && (best == none || coverage_[k] > coverage_[best]))
        best = k;
    if (best == none ||
        std::any_of(places.begin(), places.end(), [&](std::size_t k) { return representative[k] != none; }))
      continue;
    representative[best] = best;
    spread(representative);
  }
  if (!holdTurns)
    return representative;
  constexpr double narrow = 1e-6;
  for (const std::vector<std::size_t>& places : patches()) {
    std::vector<std::size_t> own;
    double most = 0;
    for (const std::size_t k : places) {
      if (representative[k] == k)
        own.push_back(k);
      if (!isHeld(k))
        most = std::max(most, coverage_[k]);
    }
    for (const bool withHeld :
         {false, true}) { // at nodes that are held the other side is tied to what does not move
      if (own.empty() || width(own) > narrow * width(places))
        break;
      own.clear();
      for (const std::size_t k : places) {
        representative[k] = coverage_[k] >= coverageOfTurns * most && (withHeld || !isHeld(k)) ? k : none;
        if (representative[k] == k)
          own.push_back(k);
      }
    }
  }
  spread(representative);
  return representative;
}

/// Gives nodes without a representative that of the nearest one around, until all that can be reached have
/// one.
void MultiplierNodes::spread(std::vector<std::size_t>& representative) const {
  for (bool isAnyNew = true; isAnyNew;) {
    isAnyNew = false;
    std::vector<std::size_t> next = representative;
    std::vector<double> distance(next.size(), std::numeric_limits<double>::infinity());
    for (const MortarFacet& facet : facets_) {
      const std::vector<std::size_t>& places = nodes_.facets[facet.facet].nodes;
      for (const std::size_t k : places)
        for (const std::size_t other : places) {
          if (representative[k] != none || representative[other] == none)
            continue;
          const double apart = (nodes_.points[representative[other]] - nodes_.points[k]).norm();
          if (apart < distance[k]) {
            distance[k] = apart;
            next[k] = representative[other];
            isAnyNew = true;
          }
        }
    }
    representative.swap(next);
  }
}

/// Places of nodes of covered facets that hang together.
std::vector<std::vector<std::size_t>> MultiplierNodes::patches() const {
  std::vector<std::size_t> root(nodes_.nodes.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto rootOf = [&](std::size_t k) {
    while (root[k] != k)
      k = root[k] = root[root[k]];
    return k;
  };
  std::vector<char> isCovered(root.size(), 0);
  for (const MortarFacet& facet : facets_)
    for (const std::size_t k : nodes_.facets[facet.facet].nodes) {
      root[rootOf(k)] = rootOf(nodes_.facets[facet.facet].nodes.front());
      isCovered[k] = 1;
    }
  std::map<std::size_t, std::vector<std::size_t>> patches;
  for (std::size_t k = 0; k < root.size(); ++k)
    if (isCovered[k] != 0)
      patches[rootOf(k)].push_back(k);
  std::vector<std::vector<std::size_t>> result;
  for (auto& [first, places] : patches)
    result.push_back(std::move(places));
  return result;
}

/// Mean square of nodes' distances from their middle, in space from the line that they are nearest to: 0 if a
/// turn moves none.
double MultiplierNodes::width(const std::vector<std::size_t>& places) const {
  const Vector3d& origin = nodes_.points[places.front()];
  const auto number = static_cast<double>(places.size());
  Vector3d middle(0, 0, 0);
  for (const std::size_t k : places)
    middle += (nodes_.points[k] - origin) / number;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const std::size_t k : places) {
    const Vector3d off = nodes_.points[k] - origin - middle;
    moments += off * off.transpose() / number;
  }
  const direct::SymmetricEigen spectrum = direct::eigenOf(moments); // ascending
  return nodes_.facets.front().numCorners == 2 ? spectrum.values[2] : spectrum.values[1];
}

} // namespace epafi::contact
