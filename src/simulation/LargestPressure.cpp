#include "epafi/simulation/LargestPressure.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/contact/UnitedSurface.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"
#include "epafi/simulation/ContactState.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <unordered_map>

namespace epafi::simulation {
namespace {

using contact::ContactLayout;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

Index at(std::size_t i) {
  return static_cast<Index>(i);
}

/// 1, ξ, ½ξ², or 1, ξ, η, ½ξ², ξη, ½η².
VectorXd monomials(const Vector2d& x, int dimension) {
  if (dimension == 1)
    return Vector3d(1, x[0], x[0] * x[0] / 2);
  VectorXd values(6);
  values << 1, x, x[0] * x[0] / 2, x[0] * x[1], x[1] * x[1] / 2;
  return values;
}

/// Nodes round the peak, and coordinates there: 0 at the peak, 1 at the farthest node along either axis.
struct Patch {
  std::vector<std::size_t> rows;
  Vector3d origin;
  Eigen::Matrix<double, 2, 3> axes = Eigen::Matrix<double, 2, 3>::Zero();
  double width = 0;
  [[nodiscard]] Vector2d coordinates(const Vector3d& x) const { return axes * (x - origin); }
};

/// The pressures of a contact, whole on every rank.
class Pressures {
public:
  /// Collective.
  Pressures(const SolvedScene& solved, const ContactLayout& layout);

  [[nodiscard]] std::size_t peak() const { return peak_; }
  [[nodiscard]] double largest() const { return means_[at(peak_)]; }
  [[nodiscard]] int numMonomials() const { return dimension_ == 1 ? 3 : 6; }
  /// Of nodes that are connected to the peak by others of at least a share of its mean.
  [[nodiscard]] Patch patch(double share) const;
  /// Weights of the rows' p_k in the largest value of the quadratic.
  [[nodiscard]] VectorXd fit(const Patch& patch) const;
  [[nodiscard]] double value(const VectorXd& weights) const { return weights.dot(means_); }
  /// g of weights of the p_k: of each multiplier.
  [[nodiscard]] VectorXd ofMultipliers(const VectorXd& weights) const;

private:
  /// Σ W x, where functions N̂ are combined of those that x belongs to.
  [[nodiscard]] MatrixXd combined(const MatrixXd& x) const;
  [[nodiscard]] Vector3d place(std::size_t row) const;
  /// ∫φ_i N̂_k/∫N̂_k, a column a row.
  [[nodiscard]] MatrixXd moments(const Patch& patch) const;

  const ContactLayout& layout_;
  const mesh::Mesh& mesh_;
  mesh::Surface surface_;
  int dimension_;
  bool isOfRevolution_;
  std::vector<std::vector<std::size_t>> facets_; ///< places of rows; none where a node has no row
  VectorXd areas_, means_;                       ///< ∫N̂_k, p_k
  std::size_t peak_ = 0;
};

constexpr std::size_t none = -1;

Pressures::Pressures(const SolvedScene& solved, const ContactLayout& layout)
    : layout_(layout), mesh_(*solved.decomposition.bodies[layout.firstBody].mesh),
      surface_(layout.firstSurfaces.empty() ? mesh_.surface(layout.firstSurface)
                                            : contact::unite(mesh_, layout.firstSurfaces).surface),
      dimension_(mesh::dimensionOf(surface_.facetType)), isOfRevolution_(solved.isOfRevolution()) {
  std::unordered_map<GlobalOrdinal, std::size_t> rowOf;
  for (std::size_t row = 0; row < layout.firstNodes.size(); ++row)
    rowOf.emplace(layout.firstNodes[row], row);
  for (std::size_t f = 0; f < surface_.numFacets(); ++f) {
    std::vector<std::size_t>& rows = facets_.emplace_back();
    for (const GlobalOrdinal node : surface_.facet(f)) {
      const auto found = rowOf.find(node);
      rows.push_back(found == rowOf.end() ? none : found->second);
    }
  }
  std::vector<double> pushes(layout.firstNodes.size(), 0.0), areas = layout.areas;
  const Map& map = *solved.decomposition.problem.multiplierMap;
  const auto multiplier = solved.solution.multiplier->getData();
  for (LocalOrdinal i = 0; i < multiplier.size(); ++i) {
    const GlobalOrdinal row = map.getGlobalElement(i) - layout.firstRow;
    if (row >= 0 && row < layout.numRows())
      pushes[row] = multiplier[i];
  }
  sumOverRanks(solved.comm(), std::span(pushes)); // each is one rank's
  const auto rowOfValues = [](const std::vector<double>& values) {
    return Eigen::Map<const Eigen::RowVectorXd>(values.data(), at(values.size()));
  };
  const bool areCombined = layout.isDual; // in the multipliers and areas themselves
  areas_ = areCombined ? MatrixXd(rowOfValues(areas)).transpose() : combined(rowOfValues(areas)).transpose();
  means_ =
      areCombined ? MatrixXd(rowOfValues(pushes)).transpose() : combined(rowOfValues(pushes)).transpose();
  means_ = means_.cwiseQuotient(areas_);
  const std::vector<std::size_t> own = layout.ownRows();
  peak_ = *std::max_element(own.begin(), own.end(),
                            [&](std::size_t a, std::size_t b) { return means_[at(a)] < means_[at(b)]; });
}

MatrixXd Pressures::combined(const MatrixXd& x) const {
  if (layout_.smoothed.empty())
    return x;
  MatrixXd result = MatrixXd::Zero(x.rows(), x.cols());
  for (std::size_t row = 0; row < layout_.smoothed.size(); ++row)
    for (const ContactLayout::Share& share : layout_.smoothed[row])
      result.col(at(row)) += share.weight * x.col(at(share.node));
  return result;
}

Vector3d Pressures::place(std::size_t row) const {
  const Point x = mesh_.point(layout_.firstNodes[row]);
  return {x[0], x[1], x[2]};
}

Patch Pressures::patch(double share) const {
  Patch patch;
  std::vector<bool> isIn(layout_.firstNodes.size(), false);
  isIn[peak_] = true;
  for (bool grows = true; grows;) {
    grows = false;
    for (const std::vector<std::size_t>& facet : facets_) {
      if (std::none_of(facet.begin(), facet.end(), [&](std::size_t row) { return row != none && isIn[row]; }))
        continue;
      for (const std::size_t row : facet)
        if (row != none && !isIn[row] && means_[at(row)] >= share * largest())
          isIn[row] = grows = true;
    }
  }
  for (std::size_t row = 0; row < isIn.size(); ++row)
    if (isIn[row])
      patch.rows.push_back(row);
  patch.origin = place(peak_);
  for (int axis = 0; axis < dimension_; ++axis) { // towards the farthest node, then across
    Vector3d farthest = Vector3d::Zero();
    for (const std::size_t row : patch.rows) {
      Vector3d x = place(row) - patch.origin;
      if (axis > 0)
        x -= patch.axes.row(0).squaredNorm() > 0
                 ? Vector3d(patch.axes.row(0).transpose() *
                            (patch.axes.row(0) * x / patch.axes.row(0).squaredNorm()))
                 : Vector3d(Vector3d::Zero());
      if (x.squaredNorm() > farthest.squaredNorm())
        farthest = x;
    }
    if (farthest.squaredNorm() > 0)
      patch.axes.row(axis) = farthest.transpose() / farthest.squaredNorm();
    patch.width = std::max(patch.width, farthest.norm());
  }
  return patch;
}

MatrixXd Pressures::moments(const Patch& patch) const {
  MatrixXd sums = MatrixXd::Zero(numMonomials(), at(layout_.firstNodes.size()));
  std::vector<Point> points;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    mesh_.pointsAt(surface_.facet(f), points);
    mesh::withFacetShape(surface_.typeOf(f), [&]<int dim>(const mesh::Shape<dim>& shape) {
      const mesh::Shape<dim>& fine = mesh::referenceShape<dim>(mesh::withOrder(shape.type, 2));
      const Eigen::Map<const Eigen::Matrix3Xd> nodes(points.front().data(), 3, shape.numNodes);
      for (const auto& rule : fine.fineSamples()) {
        const auto sample = shape.sampleAt(rule.xi, rule.weight);
        const Eigen::Matrix<double, 3, dim> tangents = mesh::derivatives(nodes, sample);
        const double area = sample.weight * std::sqrt((tangents.transpose() * tangents).determinant()) *
                            (isOfRevolution_ ? nodes.row(0).dot(sample.values) : 1); // but for a factor
        const VectorXd values = area * monomials(patch.coordinates(nodes * sample.values), dimension_);
        for (std::size_t a = 0; a < facets_[f].size(); ++a)
          if (facets_[f][a] != none)
            sums.col(at(facets_[f][a])) += sample.values[at(a)] * values;
      }
    });
  }
  sums = combined(sums);
  return sums * sums.row(0).cwiseInverse().asDiagonal();
}

VectorXd Pressures::fit(const Patch& patch) const {
  const MatrixXd phi = moments(patch);
  const Index n = numMonomials();
  MatrixXd gram = MatrixXd::Zero(n, n), rhs = MatrixXd::Zero(n, phi.cols());
  for (const std::size_t row : patch.rows) {
    const double taper = std::max(0.0, 1 - patch.coordinates(place(row)).squaredNorm());
    rhs.col(at(row)) = taper * areas_[at(row)] * phi.col(at(row));
    gram += rhs.col(at(row)) * phi.col(at(row)).transpose();
  }
  constexpr double roundOff = 1e-10;
  gram.diagonal().array() += roundOff * gram.trace();
  const MatrixXd coefficients = direct::solvedSymmetric(gram, rhs); // of the p_k
  const VectorXd c = coefficients * means_;

  Vector2d best(0, 0);
  double reach = 2; // to the nearest other node
  const auto valueAt = [&](const Vector2d& x) { return monomials(x, dimension_).dot(c); };
  for (const std::size_t row : patch.rows)
    if (const Vector2d x = patch.coordinates(place(row)); valueAt(x) > valueAt(best))
      best = x;
  for (const std::size_t row : patch.rows)
    if (const double apart = (patch.coordinates(place(row)) - best).norm(); apart > 0)
      reach = std::min(reach, apart);
  Eigen::Matrix2d hessian = -Eigen::Matrix2d::Identity();
  Vector2d slope(c[1], 0);
  if (dimension_ == 1) {
    hessian(0, 0) = c[2];
  } else {
    slope[1] = c[2];
    hessian << c[3], c[4], c[4], c[5];
  }
  if (hessian(0, 0) < 0 && hessian.determinant() > 0) {
    const Vector2d top = -hessian.inverse() * slope;
    if ((top - best).norm() <= reach)
      best = top;
  }
  return coefficients.transpose() * monomials(best, dimension_);
}

VectorXd Pressures::ofMultipliers(const VectorXd& weights) const {
  VectorXd scaled = weights.cwiseQuotient(areas_);
  if (layout_.isDual || layout_.smoothed.empty())
    return scaled;
  VectorXd result = VectorXd::Zero(scaled.size());
  for (std::size_t row = 0; row < layout_.smoothed.size(); ++row)
    for (const ContactLayout::Share& share : layout_.smoothed[row])
      result[at(share.node)] += share.weight * scaled[at(row)];
  return result;
}

} // namespace

LargestPressure largestPressure(const SolvedScene& solved, const ContactLayout& layout) {
  const RCP<const Map> map = solved.decomposition.problem.multiplierMap;
  LargestPressure result{0, rcp(new Vector(map)), 0, 0};
  const Pressures pressures(solved, layout);
  if (!(pressures.largest() > 0))
    return result;
  constexpr double widest = 0.3, finest = 0.01; // of the peak's mean, what nodes may lack
  const auto most = 4 * static_cast<std::size_t>(pressures.numMonomials());
  double band = finest;
  while (band < widest && pressures.patch(1 - band).rows.size() < most)
    band *= 2;
  const Patch patch = pressures.patch(1 - band), wider = pressures.patch(1 - 2 * band);
  VectorXd weights = VectorXd::Unit(at(layout.numRows()), at(pressures.peak()));
  if (patch.rows.size() >= most)
    weights = pressures.fit(patch);
  result.width = wider.width;
  result.value = pressures.value(weights);
  result.remainder = std::abs(result.value - pressures.value(pressures.fit(wider))) / 2;
  const VectorXd multipliers = pressures.ofMultipliers(weights);
  const auto g = result.weights->getDataNonConst();
  for (LocalOrdinal i = 0; i < g.size(); ++i) {
    const GlobalOrdinal row = map->getGlobalElement(i) - layout.firstRow;
    if (row >= 0 && row < layout.numRows())
      g[i] = multipliers[row];
  }
  return result;
}

} // namespace epafi::simulation
