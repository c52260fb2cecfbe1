#include "epafi/contact/MortarRows.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/FacingFaces.hpp"
#include "epafi/contact/MortarIntegrals.hpp"
#include "epafi/contact/QuadraticFaces.hpp"
#include "epafi/contact/RowAreas.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fem/ElementGeometry.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace epafi::contact {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A node has no multiplier if less than this share of its N̂ is covered.
constexpr double leastCoverage = 1e-3;
/// Facets covered by less than this share of them have constant ψ.
constexpr double sliverOfFacet = 0.02;
/// Shares that would be 0 without round-off.
constexpr double roundOffOfWeights = 1e-13;

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

/// What a row takes of both sides.
struct MortarRow {
  std::size_t place; ///< of its node, in SurfaceNodes
  double area;       ///< ∫N̂
  std::vector<NodeShare> first, second;
};

/// The rows of a pair of surfaces, for any set of nodes that may have them.
class RowMaker {
public:
  RowMaker(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second)
      : first_(first), second_(second), nodes_(surfaceNodes(first.pointAt, first.surface)),
        basis_(dualBasis(first.surface.facetType)), facets_(mortarIntegrals(terms, first, second)) {
    measureCoverage();
    isBent_ = faceOtherSide(facets_, nodes_);
  }

  [[nodiscard]] const SurfaceNodes& nodes() const { return nodes_; }
  /// Whether a node's normal is the mean of several faces.
  [[nodiscard]] bool isBent(std::size_t place) const { return isBent_[place] != 0; }
  /// \param isHeld  of places of nodes
  [[nodiscard]] std::vector<MortarRow> rows(const std::function<bool(std::size_t)>& isHeld,
                                            RowAreas& areas) const;
  /// From the mean place of a row's first side to that of its second.
  [[nodiscard]] Vector3d apart(const MortarRow& row) const;

private:
  using Sums = std::vector<std::map<GlobalOrdinal, double>>;

  void measureCoverage();
  [[nodiscard]] std::vector<std::size_t> placesOf(std::size_t facet) const;
  [[nodiscard]] std::vector<std::size_t>
  representatives(const std::function<bool(std::size_t)>& isHeld) const;
  void spread(std::vector<std::size_t>& representative) const;
  void add(const MortarFacet& facet, const std::vector<std::size_t>& representative,
           VectorXd& integralsOfRows, RowAreas& areas, Sums& first, Sums& second) const;
  [[nodiscard]] Vector3d relativePlace(const NodePoints& pointAt, GlobalOrdinal node,
                                       const MortarRow& row) const;
  void balanceMoment(MortarRow& row) const;

  const PlacedSurface &first_, &second_;
  SurfaceNodes nodes_;
  MatrixXd basis_; ///< N̂ = T N of a facet
  std::vector<MortarFacet> facets_;
  std::vector<double> coverage_; ///< of each node's N̂, the covered share
  std::vector<char> isBent_;
};

std::vector<std::size_t> RowMaker::placesOf(std::size_t facet) const {
  std::vector<std::size_t> places;
  for (const GlobalOrdinal node : first_.surface.facet(facet))
    places.push_back(static_cast<std::size_t>(
        std::lower_bound(nodes_.nodes.begin(), nodes_.nodes.end(), node) - nodes_.nodes.begin()));
  return places;
}

void RowMaker::measureCoverage() {
  std::vector<double> covered(nodes_.nodes.size(), 0.0), whole = covered;
  std::vector<fem::Point> points;
  VectorXd shares(basis_.rows());
  const auto addTo = [&](std::size_t facet, const VectorXd& values, std::vector<double>& sums) {
    const std::vector<std::size_t> places = placesOf(facet);
    for (std::size_t a = 0; a < places.size(); ++a)
      sums[places[a]] += values[static_cast<Eigen::Index>(a)];
  };
  for (std::size_t f = 0; f < first_.surface.numFacets(); ++f) {
    points.clear();
    for (const GlobalOrdinal node : first_.surface.facet(f))
      points.push_back(first_.pointAt(node));
    fem::nodalShares(first_.surface.facetType, points, {shares.data(), points.size()});
    addTo(f, basis_ * shares, whole);
  }
  for (const MortarFacet& facet : facets_)
    addTo(facet.facet, basis_ * facet.shares, covered);
  for (std::size_t k = 0; k < covered.size(); ++k)
    coverage_.push_back(covered[k] / whole[k]);
}

/// The node whose multiplier each node's N̂ belongs to: itself, or the nearest one in steps from facet to facet.
std::vector<std::size_t> RowMaker::representatives(const std::function<bool(std::size_t)>& isHeld) const {
  std::vector<std::size_t> representative(nodes_.nodes.size(), none);
  for (const MortarFacet& facet : facets_) {
    const std::vector<std::size_t> places = placesOf(facet.facet);
    for (std::size_t a = 0; a < places.size(); ++a)
      if (facet.isReached[a] != 0 && coverage_[places[a]] >= leastCoverage && !isHeld(places[a]))
        representative[places[a]] = places[a];
  }
  spread(representative);
  for (const MortarFacet& facet : facets_) { // where less than a facet is covered, no node may be reached
    const std::vector<std::size_t> places = placesOf(facet.facet);
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
  return representative;
}

/// Gives nodes without a representative that of the nearest one around, until all that can be reached have one.
void RowMaker::spread(std::vector<std::size_t>& representative) const {
  for (bool isAnyNew = true; isAnyNew;) {
    isAnyNew = false;
    std::vector<std::size_t> next = representative;
    std::vector<double> distance(next.size(), std::numeric_limits<double>::infinity());
    for (const MortarFacet& facet : facets_) {
      const std::vector<std::size_t> places = placesOf(facet.facet);
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

/// The parts of the rows of one facet: P = A S T, ψ = P N, with S adding up the N̂ that have one multiplier.
void RowMaker::add(const MortarFacet& facet, const std::vector<std::size_t>& representative,
                   VectorXd& integralsOfRows, RowAreas& areas, Sums& first, Sums& second) const {
  const std::vector<std::size_t> places = placesOf(facet.facet);
  std::vector<std::size_t> rows;
  for (const std::size_t k : places)
    if (representative[k] != none && std::find(rows.begin(), rows.end(), representative[k]) == rows.end())
      rows.push_back(representative[k]);
  if (rows.empty())
    return;
  const auto numRows = static_cast<Eigen::Index>(rows.size());
  MatrixXd sum = MatrixXd::Zero(numRows, basis_.rows());
  for (std::size_t a = 0; a < places.size(); ++a)
    for (Eigen::Index r = 0; r < numRows; ++r)
      if (representative[places[a]] == rows[static_cast<std::size_t>(r)])
        sum(r, static_cast<Eigen::Index>(a)) = 1;
  const MatrixXd functions = sum * basis_;
  const VectorXd integrals = functions * facet.shares;
  MatrixXd psi;
  if (facet.area < sliverOfFacet * facet.whole) {
    psi = integrals / facet.area * (VectorXd::Ones(numRows).transpose() * functions);
  } else {
    const MatrixXd mass = functions * facet.mass * functions.transpose();
    psi = integrals.asDiagonal() * direct::solvedSymmetric(mass, functions);
  }
  const MatrixXd own = psi * facet.mass;
  const auto nodes = first_.surface.facet(facet.facet);
  for (Eigen::Index r = 0; r < numRows; ++r) {
    const std::size_t row = rows[static_cast<std::size_t>(r)];
    integralsOfRows[static_cast<Eigen::Index>(row)] += integrals[r];
    areas.add(facet.facet, row, integrals[r]);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      first[row][nodes[a]] += own(r, static_cast<Eigen::Index>(a));
  }
  for (const MortarFacet::Across& across : facet.across) {
    const MatrixXd theirs = psi * across.coupling;
    const auto others = second_.surface.facet(across.facet);
    for (Eigen::Index r = 0; r < numRows; ++r)
      for (std::size_t a = 0; a < others.size(); ++a)
        second[rows[static_cast<std::size_t>(r)]][others[a]] += theirs(r, static_cast<Eigen::Index>(a));
  }
}

std::vector<MortarRow> RowMaker::rows(const std::function<bool(std::size_t)>& isHeld, RowAreas& areas) const {
  const std::vector<std::size_t> representative = representatives(isHeld);
  const std::size_t n = nodes_.nodes.size();
  VectorXd integrals = VectorXd::Zero(static_cast<Eigen::Index>(n));
  Sums first(n), second(n);
  for (const MortarFacet& facet : facets_)
    add(facet, representative, integrals, areas, first, second);
  std::vector<MortarRow> rows;
  for (std::size_t k = 0; k < n; ++k) {
    if (first[k].empty())
      continue;
    MortarRow& row = rows.emplace_back(MortarRow{k, integrals[static_cast<Eigen::Index>(k)], {}, {}});
    for (const auto& [sums, shares] : {std::pair(&first[k], &row.first), std::pair(&second[k], &row.second)})
      for (const auto& [node, weight] : *sums)
        if (std::abs(weight) > roundOffOfWeights * row.area)
          shares->push_back({node, weight / row.area});
    balanceMoment(row);
  }
  return rows;
}

/// Places relative to the row's node: far from the origin coordinates have lost the digits that sums of theirs would need.
Vector3d RowMaker::relativePlace(const NodePoints& pointAt, GlobalOrdinal node, const MortarRow& row) const {
  const fem::Point x = pointAt(node);
  return Vector3d(x[0], x[1], x[2]) - nodes_.points[row.place];
}

Vector3d RowMaker::apart(const MortarRow& row) const {
  Vector3d apart(0, 0, 0);
  for (const NodeShare& share : row.second)
    apart += share.weight * relativePlace(second_.pointAt, share.node, row);
  for (const NodeShare& share : row.first)
    apart -= share.weight * relativePlace(first_.pointAt, share.node, row);
  return apart;
}

/// Adds δ_l = cᵀ(x_l − x̄) to the second side's shares, which changes no force, so that its place lies across the first one's.
void RowMaker::balanceMoment(MortarRow& row) const {
  const Vector3d normal = nodes_.normals[row.place];
  const auto across = [&](const Vector3d& x) -> Vector3d { return x - normal.dot(x) * normal; };
  const Vector3d off = across(apart(row));
  std::vector<Vector3d> places;
  Vector3d mean(0, 0, 0);
  for (const NodeShare& share : row.second) {
    places.emplace_back(across(relativePlace(second_.pointAt, share.node, row)));
    mean += places.back() / static_cast<double>(row.second.size());
  }
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (Vector3d& place : places) {
    place -= mean;
    moments += place * place.transpose();
  }
  const double size = moments.trace();
  if (off.squaredNorm() <= roundOffOfWeights * roundOffOfWeights * size || size == 0)
    return;
  moments += size * (normal * normal.transpose() + 1e-14 * Eigen::Matrix3d::Identity());
  const Vector3d change = moments.inverse() * off;
  for (std::size_t l = 0; l < places.size(); ++l)
    row.second[l].weight -= change.dot(places[l]);
}

void enter(const MortarRow& row, const SurfaceNodes& nodes, const RowAreas& areas, const Vector3d& direction,
           int components, double gap, ContactLayout& layout) {
  layout.firstNodes.push_back(nodes.nodes[row.place]);
  layout.firstShares.push_back(row.first);
  layout.secondNodes.push_back(row.second);
  for (int c = 0; c < components; ++c)
    layout.directions.push_back(direction[c]);
  layout.gaps.push_back(gap);
  areas.enter(row.place, layout);
}

void requireMortarRows(const ContactTerms& terms, const ContactLayout& layout) {
  if (layout.firstNodes.empty())
    throw InputError(
        "contact '" + terms.name + "': supports or ties hold every node of the surface '" +
        terms.firstSurface +
        "' that meets the other one, so that none can carry a force; let the other side carry the "
        "multipliers, or remove the contact");
}

} // namespace

ContactLayout meetByMortar(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second,
                           const std::function<bool(GlobalOrdinal)>& isTied) {
  const RowMaker maker(terms, first, second);
  const SurfaceNodes& nodes = maker.nodes();
  const auto directionAt = [&](std::size_t place) -> Vector3d {
    return terms.components == 1 ? Vector3d(terms.sense, 0, 0) : nodes.normals[place];
  };
  ContactLayout layout;
  layout.name = terms.name;
  layout.isDual = first.surface.facetType == fem::CellType::triangle6;
  RowAreas areas(terms, nodes.nodes.size());
  for (const MortarRow& row :
       maker.rows([&](std::size_t k) { return isTied && isTied(nodes.nodes[k]); }, areas)) {
    double gap = terms.gap;
    if (terms.components > 1)
      gap += nodes.normals[row.place].dot(maker.apart(row));
    enter(row, nodes, areas, directionAt(row.place), terms.components, gap, layout);
    layout.numBent += terms.components > 1 && maker.isBent(row.place) ? 1 : 0;
  }
  requireMortarRows(terms, layout);
  smoothRows(first.surface, layout);
  return layout;
}

ContactLayout tieByMortar(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second,
                          const HeldNodes& isHeld, const Eigen::Matrix3d& axes) {
  const RowMaker maker(terms, first, second);
  const SurfaceNodes& nodes = maker.nodes();
  ContactLayout layout;
  layout.name = terms.name;
  for (int c = 0; c < terms.components; ++c) {
    const Vector3d axis = axes.col(c);
    RowAreas areas(terms, nodes.nodes.size());
    for (const MortarRow& row :
         maker.rows([&](std::size_t k) { return isHeld && isHeld(nodes.nodes[k], axis); }, areas))
      enter(row, nodes, areas, axis, terms.components, 0.0, layout);
  }
  requireMortarRows(terms, layout);
  layout.isDual = first.surface.facetType == fem::CellType::triangle6;
  smoothRows(first.surface, layout);
  return layout;
}

} // namespace epafi::contact
