#pragma once

/// The coarse problem S_cc x_c = z_c on the crosspoint values v_c^g. It is the one thing of global size that
/// every rank holds; all ranks factorise and solve it alike, which saves a message.
///
/// Where a body floats, S_cc is singular with the known kernel R_c (R at the crosspoints). A generalised
/// inverse is then S_cc⁺ = (S_cc + τEEᵀ)⁻¹, where E picks as many crosspoint values of every floating body as
/// it has rigid modes, so that EᵀR_c is regular: S S⁺ S = S exactly (Brzobohatý et al., *Int. J. Numer. Meth.
/// Engng* 88 (2011), fixing nodes).

#include "epafi/base/AccurateSum.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/direct/SpdFactor.hpp"
#include "epafi/fetidp/SubdomainGroup.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <string>

namespace epafi::fetidp {

class CoarseProblem {
public:
  /// Sums the subdomains' Schur complements over all ranks and factorises. Collective.
  /// \throws Error if the kernel handed over is none of S_cc, or if the factorisation fails.
  CoarseProblem(const decomposition::DecomposedProblem& problem, std::span<const SubdomainGroup> groups,
                const std::string& directSolver);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const Comm& comm() const { return *comm_; }
  /// x = S_cc⁺ Σ_ranks z: sums z over the ranks, in place (one message), then solves. Both have size()
  /// entries. Collective.
  void solve(std::span<AccurateSum> z, Eigen::VectorXd& x) const;
  [[nodiscard]] std::size_t factorBytes() const;

private:
  RCP<const Comm> comm_;
  int size_ = 0;
  std::unique_ptr<direct::SpdFactor> factor_;
  mutable Eigen::VectorXd rhs_;
};

} // namespace epafi::fetidp
