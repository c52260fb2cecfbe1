#pragma once

/// A facet, straight or curved, seen along the normal of a plane: what mortar integrals ask of either side.

#include "epafi/contact/ConvexPolygon.hpp"
#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace epafi::contact {

/// Values of a facet's shape functions.
using FacetValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, static_cast<int>(mesh::mostFacetNodes), 1>;

/// A plane with axes; in the plane a line, whose second coordinate is 0.
struct ViewPlane {
  Eigen::Vector3d origin;
  Eigen::Matrix3d axes; ///< a rotation: its first two columns span the plane, the third is its normal

  /// Through a point, along a normal of length 1. \param dimension  of space
  static ViewPlane across(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal, int dimension);
  [[nodiscard]] Eigen::Vector2d seen(const Eigen::Vector3d& x) const {
    return axes.leftCols<2>().transpose() * (x - origin);
  }
};

class FacetView {
public:
  /// Nodes in the order of Surface: the normal points outwards.
  FacetView(mesh::CellType type, std::span<const Point> points);

  [[nodiscard]] const Eigen::Vector3d& centre() const { return centre_; }
  [[nodiscard]] const Eigen::Vector3d& normal() const { return normal_; } ///< mean, of length 1
  [[nodiscard]] double area() const { return area_; }
  [[nodiscard]] double diameter() const { return diameter_; }
  /// Whether x(ξ) is affine: integrals of products of shape functions are polynomials then.
  [[nodiscard]] bool isAffine() const { return isAffine_; }
  /// Degree in x of its shape functions, if it is affine.
  [[nodiscard]] int degree() const;
  /// Corners of convex pieces that make it up: itself if its edges are straight, else its halves along each
  /// axis.
  [[nodiscard]] const std::vector<std::vector<Eigen::Vector3d>>& pieces() const { return pieces_; }
  /// Where its nodes lie, a column each.
  [[nodiscard]] const Eigen::Matrix3Xd& points() const { return points_; }

  /// What lies at a point of the plane.
  struct Sight {
    FacetValues values;
    Eigen::Vector3d place; ///< from the plane's origin
    double slope;          ///< area of the facet over that of the plane
  };
  /// Newton's method; nothing where it does not settle: the facet is folded, as one sees it.
  [[nodiscard]] std::optional<Sight> at(const Eigen::Vector2d& seen, const ViewPlane& plane) const;

private:
  mesh::CellType type_;
  Eigen::Matrix3Xd points_;
  Eigen::Vector3d centre_, normal_;
  double area_, diameter_;
  bool isAffine_ = true;
  std::vector<std::vector<Eigen::Vector3d>> pieces_;
};

} // namespace epafi::contact
