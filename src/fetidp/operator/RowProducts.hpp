#pragma once

/// Rows of B by themselves: whether they can hold together at all is a matter of what they share, not of
/// stiffness.

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::fetidp {

/// Forces that the rows of B exert on the unknowns, crosspoints merged, and what unknowns do to the rows.
class RowProducts {
public:
  /// Keeps a reference. Collective.
  explicit RowProducts(const decomposition::DecomposedProblem& problem);

  /// Bᵀλ, n_s of each of this rank's subdomains; copies of a crosspoint have the sum. \param isMagnitude
  /// |B|ᵀ|λ| instead Collective.
  [[nodiscard]] const std::vector<Eigen::VectorXd>& forces(const Vector& lambda,
                                                           bool isMagnitude = false) const;
  /// y = BBᵀλ. Collective.
  void gram(const Vector& lambda, Vector& y) const;
  /// ‖b‖ of each row, crosspoints not merged. Collective.
  [[nodiscard]] RCP<Vector> norms() const;

private:
  const decomposition::DecomposedProblem& problem_;
  RCP<const Import> crosspointPlan_; ///< from crosspointMap to this rank's coarse unknowns
  mutable MultiplierExchange exchange_;
  mutable Vector mine_, owned_; ///< coarse unknowns
  mutable std::vector<Eigen::VectorXd> forces_;
};

} // namespace epafi::fetidp
