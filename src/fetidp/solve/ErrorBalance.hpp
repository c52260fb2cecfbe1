#pragma once

/// Iterating no further than the mesh is worth: the algebraic error is to be a fraction of the discretisation
/// error, which somebody who knows the physics estimates from displacements (accuracy/ErrorEstimate.hpp for
/// scenes).

#include <Eigen/Core>

#include <functional>
#include <span>

namespace epafi::fetidp {

/// The discretisation error in the energy norm of displacements at all positions of each of this rank's
/// subdomains, those of an unfinished iteration, up to a rigid motion of bodies that float. All ranks call it
/// together and get the same value.
using DiscretisationError = std::function<double(std::span<const Eigen::VectorXd> displacement)>;

struct ErrorBalance {
  DiscretisationError estimate;
  double expected =
      0; ///< discretisation error as far as known before, say from a coarser mesh; 0: not at all
  /// Where nothing is expected: the first look comes once the algebraic error has fallen to this share of the
  /// start's. Late looks cost a few products, early ones have to be repeated.
  double firstLook = 0.01;
};

} // namespace epafi::fetidp
