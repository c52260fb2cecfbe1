#pragma once

/// How small elements should be, from the error that each makes: the mesh that reaches an error with the
/// fewest elements.
///
/// An element with the squared error η², cut into n parts, keeps η² n^(−2q/d): dimension d, and q the order
/// at which the error falls there, that of the elements where the solution is smooth, less near edges and
/// rims (LocalOrders.hpp). Of all meshes with the same error the one with n ~ (q η²)^(d/(d+2q)) has the
/// fewest elements (Lagrange). Elements whose n would be below one stay as they are: what is marked is the
/// bulk of the error.

#include <functional>
#include <span>
#include <vector>

namespace epafi::accuracy {

/// The error that is wanted, and how far meshes may go at once.
struct RefinementGoal {
  int dimension = 2;
  double error = 0;  ///< discretisation error that is wanted, in the energy norm
  double growth = 8; ///< of the number of elements, at most; if the goal is farther, equal factors lead there
  double leastGrowth = 1;  ///< less than that is not worth a mesh of its own
  double coarsening = 0;   ///< halvings that elements may lose, where meshes can get coarser
  double mostHalvings = 5; ///< that they may gain: an estimate on a coarse mesh sees no farther
};

struct WantedSizes {
  std::vector<double> halvings; ///< of each element's edges
  double growth = 1;            ///< of the number of elements, expected
  double error = 0;             ///< discretisation error, expected; 0: not known
};

/// Into how many parts each element would really be cut if such halvings were asked for: neighbours follow
/// where no node is to hang.
using Outcome = std::function<std::vector<double>(const std::vector<double>& halvings)>;

/// \param squaredErrors  η² of each element, not negative  \param orders  q of each, > 0
/// \param outcome  makes that much less be asked for as comes by itself; empty: nothing does
/// O(n), and six calls of `outcome`. Not collective: the same everywhere.
WantedSizes wantedSizes(std::span<const double> squaredErrors, std::span<const double> orders,
                        const RefinementGoal& goal, const Outcome& outcome = {});

} // namespace epafi::accuracy
