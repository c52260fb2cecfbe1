#include "epafi/contact/SmoothSurface.hpp"

#include "epafi/direct/DenseSymmetric.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>

namespace epafi::contact {
namespace {

using Eigen::Vector3d;

// Errors on cylinders and spheres of 6 to 100 facets around, nodes moved by up to 0.3 of their spacing, are
// up to 0.24 bend³ of a quadric, and up to 0.15 bend of the mean at a rim.
constexpr double ofCube = 0.25, atRim = 0.25;
/// A quadric that misses the nodes by more than the fourth power of their distance leaves its slope open,
/// too.
constexpr double ofResidual = 2;

double angleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Corners of the straight pieces that make up a facet, all its nodes among them.
std::vector<std::vector<std::size_t>> piecesOf(mesh::CellType type) {
  switch (type) {
  case mesh::CellType::line3:
    return {{0, 2}, {2, 1}};
  case mesh::CellType::triangle6:
    return {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  case mesh::CellType::quadrilateral9:
    return {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}};
  case mesh::CellType::quadrilateral8:
    return {{0, 4, 7}, {4, 1, 5}, {5, 2, 6}, {6, 3, 7}, {4, 5, 6, 7}};
  case mesh::CellType::line:
    return {{0, 1}};
  case mesh::CellType::triangle:
    return {{0, 1, 2}};
  default:
    return {{0, 1, 2, 3}};
  }
}

} // namespace

SmoothSurface::SmoothSurface(const NodePoints& pointAt, const mesh::Surface& surface)
    : isInSpace_(dimensionOf(surface.facetType) == 2) {
  for (const GlobalOrdinal node : surface.facetNodes)
    if (placeOf_.try_emplace(node, points_.size()).second) {
      const Point x = pointAt(node);
      points_.emplace_back(x[0], x[1], isInSpace_ ? x[2] : 0.0);
    }
  pieces_.resize(points_.size());
  std::vector<std::vector<std::size_t>> facets(surface.numFacets());
  bool isStraight = true;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (const GlobalOrdinal node : surface.facet(f))
      facets[f].push_back(placeOf_.at(node));
    isStraight = isStraight && noteMiddles(surface.typeOf(f), facets[f]);
  }
  if (!isStraight)
    middles_.clear();
  std::vector<std::size_t> corners;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (const auto& piece : piecesOf(isStraight ? withOrder(surface.typeOf(f), 1) : surface.typeOf(f))) {
      corners.clear();
      for (const std::size_t corner : piece)
        corners.push_back(facets[f][corner]);
      addPiece(corners);
    }
}

/// Notes the nodes of a facet that are no corners; returns whether they lie in the middle of these.
bool SmoothSurface::noteMiddles(mesh::CellType type, const std::vector<std::size_t>& facet) {
  constexpr double straight = 1e-9;
  const std::span<const int> edges = edgesOf(type);
  const std::size_t numCorners = numCornersOf(type);
  for (std::size_t node = numCorners; node < facet.size(); ++node) {
    std::vector<std::size_t>& ends = middles_[facet[node]];
    ends.clear();
    if (const std::size_t e = 2 * (node - numCorners); e < edges.size())
      ends = {facet[edges[e]], facet[edges[e + 1]]};
    else
      ends.assign(facet.begin(), facet.begin() + numCorners);
    Vector3d middle(0, 0, 0);
    for (const std::size_t end : ends)
      middle += points_[end] / static_cast<double>(ends.size());
    if ((points_[facet[node]] - middle).norm() > straight * (points_[ends[0]] - points_[ends[1]]).norm())
      return false;
  }
  return true;
}

void SmoothSurface::addPiece(std::span<const std::size_t> corners) {
  const std::size_t n = corners.size();
  for (std::size_t c = 0; c < n; ++c) {
    const Vector3d next = points_[corners[(c + 1) % n]] - points_[corners[c]],
                   last = points_[corners[(c + n - 1) % n]] - points_[corners[c]];
    Vector3d normal(0, 0, 0);
    double weight = 0;
    if (isInSpace_) {
      normal = next.cross(last);
      weight = normal.norm() / (next.squaredNorm() * last.squaredNorm());
    } else {
      const Vector3d along = c == 0 ? next : Vector3d(-next);
      normal = Vector3d(along[1], -along[0], 0);
      weight = 1 / along.norm();
    }
    Piece& piece = pieces_[corners[c]].emplace_back(Piece{normal.normalized(), weight, {}});
    for (const std::size_t other : corners)
      if (other != corners[c])
        piece.around.push_back(other);
  }
}

SmoothSurface::Mean SmoothSurface::meanAt(std::size_t place) const {
  Mean mean{Vector3d::Zero(), 0};
  for (const Piece& piece : pieces_[place])
    mean.normal += piece.weight * piece.normal;
  mean.normal.normalize();
  for (const Piece& piece : pieces_[place])
    mean.bend = std::max(mean.bend, angleBetween(piece.normal, mean.normal));
  return mean;
}

/// Normal of the quadric z = ax + by + cx² + dxy + ey² that is nearest to the nodes around, z along about
/// that normal; nothing if they do not tell.
std::optional<UncertainNormal> SmoothSurface::fitted(std::size_t place, Vector3d normal) const {
  std::set<std::size_t> around;
  for (const Piece& piece : pieces_[place])
    around.insert(piece.around.begin(), piece.around.end());
  constexpr int numUnknowns = 5;
  if (!isInSpace_ || around.size() < numUnknowns)
    return std::nullopt;
  double size = 0, residual = 0;
  for (const std::size_t other : around)
    size = std::max(size, (points_[other] - points_[place]).norm());
  for (int step = 0; step < 2; ++step) {
    const Vector3d first = normal.unitOrthogonal(), second = normal.cross(first);
    Eigen::Matrix<double, numUnknowns, numUnknowns> products = decltype(products)::Zero();
    Eigen::Matrix<double, numUnknowns, 1> heights = decltype(heights)::Zero();
    double squares = 0;
    for (const std::size_t other : around) {
      const Vector3d offset = (points_[other] - points_[place]) / size;
      const double x = offset.dot(first), y = offset.dot(second), z = offset.dot(normal);
      const decltype(heights) terms(x, y, x * x, x * y, y * y);
      products += terms * terms.transpose();
      heights += z * terms;
      squares += z * z;
    }
    const direct::SymmetricEigen spectrum = direct::eigenOf(products);
    constexpr double tells = 2e-3; // singular values down to 1/20 of the largest
    if (spectrum.values[0] < tells * spectrum.values[numUnknowns - 1])
      return std::nullopt;
    const decltype(heights) quadric =
        spectrum.vectors * (spectrum.vectors.transpose() * heights).cwiseQuotient(spectrum.values);
    residual = std::sqrt(std::max(squares - quadric.dot(heights), 0.0) / static_cast<double>(around.size()));
    normal = (normal - quadric[0] * first - quadric[1] * second).normalized();
  }
  return UncertainNormal{normal, ofResidual * residual};
}

std::optional<UncertainNormal> SmoothSurface::computed(std::size_t place) const {
  if (const auto middle = middles_.find(place); middle != middles_.end()) {
    UncertainNormal mean{Vector3d::Zero(), 0}; // on cylinders and spheres linear in the place
    for (const std::size_t end : middle->second) {
      const std::optional<UncertainNormal> normal = computed(end);
      if (!normal)
        return std::nullopt;
      mean.direction += normal->direction;
      mean.uncertainty += normal->uncertainty / static_cast<double>(middle->second.size());
    }
    mean.direction.normalize();
    return mean;
  }
  const Mean mean = meanAt(place);
  if (mean.bend > edge)
    return std::nullopt;
  const std::size_t numPieces = pieces_[place].size();
  if (auto normal = fitted(place, mean.normal)) {
    normal->uncertainty += ofCube * std::pow(mean.bend, 3);
    return normal;
  }
  if (!isInSpace_ && numPieces == 2)
    return UncertainNormal{mean.normal, ofCube * std::pow(mean.bend, 3)};
  double bend = mean.bend; // at a rim the nodes around know more of it
  for (const Piece& piece : pieces_[place])
    for (const std::size_t other : piece.around)
      if (const double there = meanAt(other).bend; there <= edge)
        bend = std::max(bend, there);
  return UncertainNormal{mean.normal, (numPieces == 1 ? 1 : atRim) * bend};
}

const std::optional<UncertainNormal>& SmoothSurface::at(GlobalOrdinal node) const {
  const std::size_t place = placeOf_.at(node);
  const auto [known, isNew] = known_.try_emplace(place);
  if (isNew)
    known->second = computed(place);
  return known->second;
}

} // namespace epafi::contact
