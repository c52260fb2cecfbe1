#pragma once

/// S_ΔΔ, the stiffness of each subdomain condensed to its boundary Δ while its crosspoints are held
/// (fetidp/CondensedSubdomain.hpp).

#include "epafi/direct/SymmetricBlock.hpp"
#include "epafi/fetidp/GeneralizedInverse.hpp"

#include <memory>
#include <vector>

namespace epafi::linear {

using fetidp::SubdomainVectors;

/// A dense block for each group of identical subdomains; nothing is collective.
class BoundaryStiffness {
public:
  /// Shares `inverse`. \throws std::bad_alloc
  BoundaryStiffness(const decomposition::DecomposedProblem& problem,
                    std::shared_ptr<const fetidp::GeneralizedInverse> inverse);

  /// forces_Δ = S_ΔΔ u_Δ in all columns of all subdomains; the other entries become 0.
  void apply(const SubdomainVectors& u, SubdomainVectors& forces) const;
  /// Unknowns of the boundary of this rank's subdomain s, in the order of the blocks.
  [[nodiscard]] const std::vector<int>& boundary(std::size_t s) const { return boundary_[s]; }
  [[nodiscard]] std::size_t bytes() const;

private:
  std::shared_ptr<const fetidp::GeneralizedInverse> inverse_;
  std::vector<std::shared_ptr<const direct::SymmetricBlock>> blocks_; ///< of each group
  std::vector<std::vector<int>> boundary_;                            ///< of each subdomain
  mutable Eigen::MatrixXd input_, output_;                            ///< work, n_Δ × mk
};

} // namespace epafi::linear
