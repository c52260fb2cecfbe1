#pragma once

/// Rigid motions that contacts leave room for.

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace epafi::fetidp {

/// The shortest x with Cᵀx ≤ s, or if there is none the columns of C that exclude it.
struct ShortestMotion {
  std::optional<Eigen::VectorXd> x;
  std::vector<Eigen::Index> excluding;
};
/// To 1e-9 of the largest |s|. Those that exclude it are those that forces y ≥ 0 with Cy = 0, yᵀs < 0 act
/// along (Lawson, Hanson, *Solving Least Squares Problems*, 1974, ch. 23.4: least distance programming).
ShortestMotion shortestMotion(const Eigen::MatrixXd& c, const Eigen::VectorXd& s);

/// A motion β in the span of `open` that all contacts that meet it leave room for, directionsᵀβ ≤ room, or
/// nothing if they leave none: then those that exclude it hold the motions across them, and the search goes
/// on along them.
/// \param directions  of the contacts, columns of length 1
/// \param room        of each, what it is to be left as a margin taken off; negative where it is to open
/// \param meets       what a contact does to a motion of length 1 at least if it meets it
std::optional<Eigen::VectorXd> looseMotion(const Eigen::MatrixXd& directions, const Eigen::VectorXd& room,
                                           Eigen::MatrixXd open, double meets);

} // namespace epafi::fetidp
