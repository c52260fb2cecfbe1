#pragma once

/// The smooth surface that facets stand for: its normals at nodes, and how far they may be off.
///
/// The mean of facets' normals, along which contact is computed, is off by the order of the angle between
/// them where nodes are unevenly spaced: enough to seem to hold a round body that nothing holds. The normal
/// of a quadric through the nodes around is off by the third power of that angle; where these are too few, at
/// rims, the mean with the weights of Max (*J. Graphics Tools* 4 (1999); exact on circles in the plane, and
/// on spheres away from rims) by a seventh of it.

#include "epafi/contact/SurfaceNodes.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace epafi::contact {

/// A unit vector that is known up to an angle, in radians.
struct UncertainNormal {
  Eigen::Vector3d direction;
  double uncertainty; ///< round-off on planes
};

/// Not collective.
class SmoothSurface {
public:
  /// \param pointAt  of all the surface's nodes; asked for here alone
  SmoothSurface(const NodePoints& pointAt, const mesh::Surface& surface);

  /// Outwards; nothing where facets meet at an edge (their normals are farther than `edge` off the mean),
  /// which is no noise. What is computed once is kept. Precondition: a node of the surface.
  [[nodiscard]] const std::optional<UncertainNormal>& at(GlobalOrdinal node) const;

  /// A little less than half the angle between six facets around, which are a nut's.
  static constexpr double edge = 0.49;

private:
  /// A straight piece of a facet, at a node.
  struct Piece {
    Eigen::Vector3d normal;          ///< of length 1
    double weight;                   ///< of Max
    std::vector<std::size_t> around; ///< its other corners
  };
  struct Mean {
    Eigen::Vector3d normal;
    double bend; ///< largest angle of a piece's normal with it
  };

  bool noteMiddles(mesh::CellType type, const std::vector<std::size_t>& facet);
  void addPiece(std::span<const std::size_t> corners);
  [[nodiscard]] Mean meanAt(std::size_t place) const;
  [[nodiscard]] std::optional<UncertainNormal> fitted(std::size_t place, Eigen::Vector3d normal) const;
  [[nodiscard]] std::optional<UncertainNormal> computed(std::size_t place) const;

  bool isInSpace_;
  std::map<GlobalOrdinal, std::size_t> placeOf_;
  std::vector<Eigen::Vector3d> points_;
  std::map<std::size_t, std::vector<std::size_t>>
      middles_;                            ///< where no facet is curved: of corners, the nodes that are none
  std::vector<std::vector<Piece>> pieces_; ///< at each other node
  mutable std::map<std::size_t, std::optional<UncertainNormal>> known_;
};

} // namespace epafi::contact
