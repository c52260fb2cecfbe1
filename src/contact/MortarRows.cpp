#include "epafi/contact/MortarRows.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/FacingFaces.hpp"
#include "epafi/contact/MortarIntegrals.hpp"
#include "epafi/contact/MultiplierNodes.hpp"
#include "epafi/contact/QuadraticFaces.hpp"
#include "epafi/contact/RowAreas.hpp"
#include "epafi/decomposition/FrictionRows.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace epafi::contact {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Facets covered by less than this share of them have constant ψ.
constexpr double sliverOfFacet = 0.02;
/// Shares that would be 0 without round-off.
constexpr double roundOffOfWeights = 1e-13;

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
      : first_(first), second_(second),
        nodes_(surfaceNodes(first.pointAt, first.surface, 0, terms.isOfRevolution)),
        bases_(dualBases(first.surface)), facets_(mortarIntegrals(terms, first, second)),
        multiplierNodes_(nodes_, bases_, facets_) {
    isBent_ = faceOtherSide(facets_, nodes_);
  }

  [[nodiscard]] const SurfaceNodes& nodes() const { return nodes_; }
  /// Whether a node's normal is the mean of several faces.
  [[nodiscard]] bool isBent(std::size_t place) const { return isBent_[place] != 0; }
  /// \param isHeld  of places of nodes
  /// \param holdTurns  whether rows must hinder all turns of the surfaces, as ties do
  [[nodiscard]] std::vector<MortarRow> rows(const std::function<bool(std::size_t)>& isHeld, bool holdTurns,
                                            RowAreas& areas) const;
  /// From the mean place of a row's first side to that of its second.
  [[nodiscard]] Vector3d apart(const MortarRow& row) const;

private:
  using Sums = std::vector<std::map<GlobalOrdinal, double>>;

  void add(const MortarFacet& facet, const std::vector<std::size_t>& representative,
           VectorXd& integralsOfRows, RowAreas& areas, Sums& first, Sums& second) const;
  [[nodiscard]] Vector3d relativePlace(const NodePoints& pointAt, GlobalOrdinal node,
                                       const MortarRow& row) const;
  void balanceMoment(MortarRow& row) const;

  const PlacedSurface &first_, &second_;
  SurfaceNodes nodes_;
  std::map<std::size_t, MatrixXd> bases_; ///< N̂ = T N of a facet, by its number of nodes
  std::vector<MortarFacet> facets_;
  MultiplierNodes multiplierNodes_;
  std::vector<char> isBent_;
};

/// The parts of the rows of one facet: P = A S T, ψ = P N, with S adding up the N̂ that have one multiplier.
void RowMaker::add(const MortarFacet& facet, const std::vector<std::size_t>& representative,
                   VectorXd& integralsOfRows, RowAreas& areas, Sums& first, Sums& second) const {
  const std::vector<std::size_t>& places = nodes_.facets[facet.facet].nodes;
  std::vector<std::size_t> rows;
  for (const std::size_t k : places)
    if (representative[k] != MultiplierNodes::none &&
        std::find(rows.begin(), rows.end(), representative[k]) == rows.end())
      rows.push_back(representative[k]);
  if (rows.empty())
    return;
  const Eigen::Index numRows = rows.size();
  MatrixXd sum = MatrixXd::Zero(numRows, std::ssize(places));
  for (std::size_t a = 0; a < places.size(); ++a)
    for (Eigen::Index r = 0; r < numRows; ++r)
      if (representative[places[a]] == rows[r])
        sum(r, a) = 1;
  const MatrixXd functions = sum * bases_.at(places.size());
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
    const std::size_t row = rows[r];
    integralsOfRows[row] += integrals[r];
    areas.add(facet.facet, row, integrals[r]);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      first[row][nodes[a]] += own(r, a);
  }
  for (const MortarFacet::Across& across : facet.across) {
    const MatrixXd theirs = psi * across.coupling;
    const auto others = second_.surface.facet(across.facet);
    for (Eigen::Index r = 0; r < numRows; ++r)
      for (std::size_t a = 0; a < others.size(); ++a)
        second[rows[r]][others[a]] += theirs(r, a);
  }
}

std::vector<MortarRow> RowMaker::rows(const std::function<bool(std::size_t)>& isHeld, bool holdTurns,
                                      RowAreas& areas) const {
  const std::vector<std::size_t> representative = multiplierNodes_.representatives(isHeld, holdTurns);
  const std::size_t n = nodes_.nodes.size();
  VectorXd integrals = VectorXd::Zero(n);
  Sums first(n), second(n);
  for (const MortarFacet& facet : facets_)
    add(facet, representative, integrals, areas, first, second);
  std::vector<MortarRow> rows;
  for (std::size_t k = 0; k < n; ++k) {
    if (first[k].empty())
      continue;
    MortarRow& row = rows.emplace_back(MortarRow{k, integrals[k], {}, {}});
    for (const auto& [sums, shares] : {std::pair(&first[k], &row.first), std::pair(&second[k], &row.second)})
      for (const auto& [node, weight] : *sums)
        if (std::abs(weight) > roundOffOfWeights * row.area)
          shares->push_back({node, weight / row.area});
    balanceMoment(row);
  }
  return rows;
}

/// Places relative to the row's node: far from the origin coordinates have lost the digits that sums of
/// theirs would need.
Vector3d RowMaker::relativePlace(const NodePoints& pointAt, GlobalOrdinal node, const MortarRow& row) const {
  const Point x = pointAt(node);
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

/// Adds δ_l = cᵀ(x_l − x̄) to the second side's shares, which changes no force, so that its place lies across
/// the first one's.
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
  layout.isDual = haveDualRows(first.surface.facetType);
  RowAreas areas(terms, nodes.nodes.size());
  for (const MortarRow& row :
       maker.rows([&](std::size_t k) { return isTied && isTied(nodes.nodes[k]); }, false, areas)) {
    const double apart = terms.components > 1 ? nodes.normals[row.place].dot(maker.apart(row)) : 0;
    enter(row, nodes, areas, directionAt(row.place), terms.components,
          terms.gapOf(nodes.nodes[row.place], apart), layout);
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
  const auto axisAt = [&](std::size_t place, int c) -> Vector3d {
    const Vector3d& normal = nodes.normals[place];
    return !terms.givesWay ? axes.col(c) : c == 0 ? normal : decomposition::tangentsOf(normal)[c - 1];
  };
  for (int c = 0; c < terms.components; ++c) {
    RowAreas areas(terms, nodes.nodes.size());
    const auto isLeftOut = [&](std::size_t k) {
      return !terms.givesWay && isHeld && isHeld(nodes.nodes[k], axisAt(k, c));
    };
    for (const MortarRow& row : maker.rows(isLeftOut, terms.components > 1, areas))
      enter(row, nodes, areas, axisAt(row.place, c), terms.components, 0.0, layout);
  }
  requireMortarRows(terms, layout);
  layout.isDual = haveDualRows(first.surface.facetType);
  if (!terms.givesWay) // else rows of a component have several directions, and are dual where this matters
    smoothRows(first.surface, layout);
  return layout;
}

} // namespace epafi::contact
