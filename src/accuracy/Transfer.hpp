#pragma once

/// A solution on one mesh in the terms of a finer one: as a first guess, or to compare.

#include "epafi/model/Decompose.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::accuracy {

/// At which nodes values are wanted.
enum class NodesOf {
  subdomains, ///< all of them
  interfaces  ///< those that subdomains share or contact touches
};

/// Values of `displacement` at nodes of `to`, at all positions of each of this rank's subdomains; 0 at other
/// nodes. Where the body of `to` reaches beyond that of `from`, the nearest value.
/// \param from          decomposition of a scene on a coarse mesh
/// \param displacement  u at all positions of each of this rank's subdomains of `from`
/// \param to  decomposition of the same scene on another mesh: the same bodies in the same order Each rank
/// gets the values that it needs and no more. Where meshes of `from` are pieces, guesses at interfaces are
/// those of held elements: good where both are cut alike, as `coarserScene` cuts them. Collective. \throws
/// Error if values at all nodes are wanted of pieces.
std::vector<Eigen::VectorXd> interpolate(const model::Decomposition& from,
                                         std::span<const Eigen::VectorXd> displacement,
                                         const model::Decomposition& to, NodesOf nodes);

} // namespace epafi::accuracy
