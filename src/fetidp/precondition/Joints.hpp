#pragma once

/// Which subdomains the rows of B join. All rows of gluing that join the same ones form a *joint*: in the
/// plane an edge between two subdomains of a body; in space a face, or the part of an edge where the same
/// three or more meet. So do the rows of contact between the same subdomains of two bodies, or between one
/// and an obstacle. Rows that touch crosspoint values are in none.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <vector>

namespace epafi::fetidp {

using decomposition::RowKind;

struct Joint {
  std::vector<int> subdomains; ///< numbers, ascending
  std::vector<int> rows;       ///< local indices in multiplierGhostMap, ascending by global index
};

/// The joints that this rank's subdomains take part in, ascending by their first row's global index; a rank
/// has all rows of each of them. \param plan from multiplierMap to multiplierGhostMap. Messages between
/// neighbours, two for every subdomain that meets in a joint. Collective.
std::vector<Joint> jointsOf(const decomposition::DecomposedProblem& problem, const Import& plan,
                            RowKind kind);

/// Of each body: whether one of its subdomains is stiffer than another by more than the factor `ratio`, by
/// the largest diagonal entry of K^s on its boundary. The same on all ranks. Collective.
std::vector<bool> bodiesOfVaryingStiffness(const decomposition::DecomposedProblem& problem, double ratio);

/// Of each joint: whether the stiffness along it varies by more than the factor `ratio` in one of its
/// subdomains, by the diagonal of K^s at its nodes, or one of its subdomains is of a body that is `always`
/// said to. The same on all ranks that have the joint. \param always of each body, or empty: none.
/// Collective.
std::vector<bool> stiffnessVaries(const decomposition::DecomposedProblem& problem, const Import& plan,
                                  const std::vector<Joint>& joints, double ratio,
                                  const std::vector<bool>& always = {});

} // namespace epafi::fetidp
