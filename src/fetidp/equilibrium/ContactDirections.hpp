#pragma once

/// In which directions contact hinders the rigid motions of the floating bodies: the columns of G̃, without
/// repetitions.

#include "epafi/decomposition/ProblemData.hpp"

#include <Eigen/Core>

#include <map>
#include <vector>

namespace epafi::fetidp {

/// Whether this rank's row (local index in multiplierMap) holds both ways: those of ties, and of friction.
bool isTied(const decomposition::DecomposedProblem& problem, int row);

/// Directions of length 1 in k dimensions, each with a number; those that agree to 1e-9 are one, with the
/// least number.
class DistinctDirections {
public:
  explicit DistinctDirections(Eigen::Index dimension) : dimension_(dimension) {}

  /// Takes in `direction`/‖direction‖ with `value`/‖direction‖. A direction 0 is left out. Logarithmic in
  /// their number.
  void add(const Eigen::VectorXd& direction, double value);
  /// Takes in those of all ranks. Collective.
  void gather(const Comm& comm);

  /// k × (as many as differ), in an order of their own: the same on all ranks after gather().
  [[nodiscard]] Eigen::MatrixXd matrix() const;
  /// In the same order.
  [[nodiscard]] Eigen::VectorXd values() const;

private:
  [[nodiscard]] Eigen::MatrixXd all() const;

  Eigen::Index dimension_;
  std::map<std::vector<long long>, Eigen::VectorXd>
      known_; ///< direction and number, by the rounded direction
};

/// The directions in which rows hinder motions, of ties both, k × (as many as differ): 𝒪(n log n) in the
/// number of rows.
/// With Coulomb's friction the edges of a node's cone of forces; in space those of a pyramid around it.
/// \param rows  see ProblemScales::hinderingRows
/// Collective.
Eigen::MatrixXd contactDirections(const decomposition::DecomposedProblem& problem,
                                  const decomposition::ProblemData& data,
                                  const std::map<int, Eigen::VectorXd>& rows);

} // namespace epafi::fetidp
