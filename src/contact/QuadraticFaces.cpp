#include "epafi/contact/QuadraticFaces.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace epafi::contact {
namespace {

using Weights = std::map<std::pair<std::size_t, std::size_t>, double>; ///< W_kb
using Shares = std::vector<std::vector<ContactLayout::Share>>;

/// Areas below this share of the mean are round-off.
constexpr double roundOff = 1e-9;

double alphaOf(const mesh::Surface& surface) {
  mesh::CellType largest = mesh::CellType::triangle6;
  for (std::size_t f = 0; f < surface.numFacets(); ++f)
    largest = std::max(largest, surface.typeOf(f));
  return largest == mesh::CellType::triangle6        ? 1.0 / 6
         : largest == mesh::CellType::quadrilateral8 ? 0.325
                                                     : 0.15;
}

/// W of one facet's nodes that have rows.
class FacetWeights {
public:
  FacetWeights(mesh::CellType facet, double alpha, Weights& weights)
      : facet_(facet), alpha_(alpha), weights_(weights) {}

  /// \param rows  of the facet's nodes, −1: none
  void add(std::span<const std::ptrdiff_t> rows) {
    const std::size_t numCorners = numCornersOf(facet_);
    const std::span<const int> ends = edgesOf(facet_);
    bool isComplete = true;
    for (std::size_t c = 0; c < numCorners; ++c) {
      set(rows[c], rows[c], 1);
      isComplete = isComplete && rows[c] >= 0;
    }
    for (std::size_t edge = 0; 2 * edge < ends.size(); ++edge) {
      const std::ptrdiff_t middle = rows[numCorners + edge];
      const std::ptrdiff_t first = rows[ends[2 * edge]], second = rows[ends[2 * edge + 1]];
      isComplete = isComplete && middle >= 0;
      const bool isWhole = first >= 0 && second >= 0;
      set(middle, middle, isWhole ? 1 - 2 * alpha_ : 1);
      if (isWhole) {
        set(first, middle, alpha_);
        set(second, middle, alpha_);
      }
    }
    if (facet_ == mesh::CellType::quadrilateral9)
      addCentre(rows, isComplete);
  }

private:
  void addCentre(std::span<const std::ptrdiff_t> rows, bool isComplete) {
    const std::ptrdiff_t centre = rows.back();
    set(centre, centre, isComplete ? (1 - 2 * alpha_) * (1 - 2 * alpha_) : 1);
    if (!isComplete)
      return;
    for (std::size_t node = 0; node < 4; ++node) {
      set(rows[node], centre, alpha_ * alpha_);
      set(rows[4 + node], centre, alpha_ * (1 - 2 * alpha_));
    }
  }

  void set(std::ptrdiff_t function, std::ptrdiff_t node, double weight) {
    if (function >= 0 && node >= 0)
      weights_[{static_cast<std::size_t>(function), static_cast<std::size_t>(node)}] = weight;
  }

  mesh::CellType facet_;
  double alpha_;
  Weights& weights_;
};

/// The inverse of Wᵀ, whose rows W has left for corners as they are.
Shares dualCombinations(const Weights& weights, double alpha, std::size_t numRows) {
  Shares combinations(numRows);
  for (std::size_t row = 0; row < numRows; ++row)
    combinations[row] = {{row, 1 / weights.at({row, row})}};
  for (const auto& [place, weight] : weights)
    if (place.first != place.second)
      combinations[place.second].push_back({place.first, -alpha / (1 - 2 * alpha)});
  return combinations;
}

/// Adds W of some rows, 0 entries left out.
void addWeights(const mesh::Surface& surface, const std::map<GlobalOrdinal, std::ptrdiff_t>& rowOf,
                Weights& weights) {
  const double alpha = alphaOf(surface);
  std::vector<std::ptrdiff_t> rows;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    rows.clear();
    for (const GlobalOrdinal node : surface.facet(f)) {
      const auto row = rowOf.find(node);
      rows.push_back(row == rowOf.end() ? -1 : row->second);
    }
    FacetWeights(surface.typeOf(f), alpha, weights).add(rows);
  }
}

/// W; of tied joints, whose nodes come once for each component that supports leave them, of each of these.
Weights weightsOf(const mesh::Surface& surface, const ContactLayout& contact) {
  const std::size_t numRows = contact.firstNodes.size();
  const bool hasComponents =
      std::set<GlobalOrdinal>(contact.firstNodes.begin(), contact.firstNodes.end()).size() < numRows;
  const std::ptrdiff_t components = contact.directions.size() / std::max<std::size_t>(1, numRows);
  std::map<std::vector<double>, std::map<GlobalOrdinal, std::ptrdiff_t>>
      rowsAlong; // directions, if there are several
  for (std::ptrdiff_t row = 0; row < static_cast<std::ptrdiff_t>(numRows); ++row) {
    const auto direction = contact.directions.begin() + row * components;
    std::vector<double> along;
    if (hasComponents)
      along.assign(direction, direction + components);
    rowsAlong[along].emplace(contact.firstNodes[row], row);
  }
  Weights weights;
  for (const auto& [along, rowOf] : rowsAlong)
    addWeights(surface, rowOf, weights);
  return weights;
}

/// N̂ = T N on one facet.
Eigen::MatrixXd dualBasis(mesh::CellType facet, double alpha) {
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(numNodesOf(facet), numNodesOf(facet));
  if (!haveDualRows(facet))
    return basis;
  const std::span<const int> ends = edgesOf(facet);
  for (std::size_t end = 0; end < ends.size(); ++end) {
    const Eigen::Index middle = numCornersOf(facet) + end / 2;
    basis(ends[end], middle) = alpha;
    basis(middle, middle) = 1 - 2 * alpha;
  }
  return basis;
}

void setSmoothed(const Weights& weights, ContactLayout& contact) {
  contact.smoothed.assign(contact.firstNodes.size(), {});
  for (const auto& [place, weight] : weights)
    contact.smoothed[place.first].push_back({place.second, weight});
}

} // namespace

bool haveDualRows(mesh::CellType facet) {
  return facet == mesh::CellType::triangle6 || facet == mesh::CellType::quadrilateral8;
}

std::map<std::size_t, Eigen::MatrixXd> dualBases(const mesh::Surface& surface) {
  std::map<std::size_t, Eigen::MatrixXd> bases;
  for (std::size_t f = 0; f < surface.numFacets(); ++f)
    if (const std::size_t number = surface.facet(f).size(); !bases.contains(number))
      bases[number] = dualBasis(surface.typeOf(f), alphaOf(surface));
  return bases;
}

void smoothRows(const mesh::Surface& surface, ContactLayout& contact) {
  if (orderOf(surface.facetType) == 2)
    setSmoothed(weightsOf(surface, contact), contact);
}

void adaptRows(const mesh::Surface& surface, ContactLayout& contact) {
  if (orderOf(surface.facetType) < 2)
    return;
  const Weights weights = weightsOf(surface, contact);
  setSmoothed(weights, contact);
  if (!haveDualRows(surface.facetType))
    return;
  contact.isDual = true;
  contact.combinations = dualCombinations(weights, alphaOf(surface), contact.firstNodes.size());
  const auto combine = [&](std::vector<double>& values) {
    std::vector<double> sums(values.size(), 0.0);
    for (const auto& [place, weight] : weights)
      sums[place.first] += weight * values[place.second];
    values = std::move(sums);
  };
  combine(contact.areas);
  for (std::vector<double>& areas : contact.areasOfParts)
    combine(areas);
  // A corner none of whose middles has a row has ∫N = 0, which nothing may be divided by: as much as others
  // have, then.
  const double mean = std::accumulate(contact.areas.begin(), contact.areas.end(), 0.0) /
                      static_cast<double>(contact.areas.size());
  for (std::size_t row = 0; row < contact.areas.size(); ++row)
    if (!(contact.areas[row] > roundOff * mean)) {
      contact.areas[row] = mean;
      for (std::vector<double>& areas : contact.areasOfParts)
        areas[row] = mean / static_cast<double>(contact.areasOfParts.size());
    }
}

} // namespace epafi::contact
