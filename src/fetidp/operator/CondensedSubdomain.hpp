#pragma once

/// One subdomain condensed: K_rr factorised with its boundary last, and what couples boundary and
/// crosspoints.
///
/// The unknowns are remainders r = (I, Δ), of which B touches Δ, and crosspoints c. One factor gives
///   S_ΔΔ = K_ΔΔ − K_ΔI K_II⁻¹ K_IΔ,   (K_rr⁻¹)_ΔΔ = S_ΔΔ⁻¹,
///   Ψ = K_rr⁻¹ K_rc,                  S = K_cc − K_cr Ψ,
/// and from these come F's local part, the coarse matrix and the Dirichlet preconditioner (theory:
/// docs/theory.md).

#include "epafi/direct/SpdFactor.hpp"
#include "epafi/fetidp/operator/SubdomainInterface.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace epafi::fetidp {

/// The block of a sparse matrix with the given rows and columns; both lists ascending.
decomposition::SparseMatrix block(const decomposition::SparseMatrix& matrix, const std::vector<int>& rows,
                                  const std::vector<int>& columns);

/// A subdomain condensed to its boundary Δ, both ways.
struct CondensedBoundary {
  Eigen::MatrixXd stiffness, flexibility; ///< S_ΔΔ and its inverse, n_Δ × n_Δ
};

/// Shared by all subdomains that are identical. n_r remainders, n_Δ of them in the boundary, n_c crosspoint
/// values.
class CondensedSubdomain {
public:
  /// \param isShared  whether others are identical: then Ψ is kept for all of them, else Ψ_Δ alone
  /// \param like  a factor whose ordering and symbolic part are used again where patterns agree, or null
  /// Not collective. \throws Error if the factorisation fails.
  CondensedSubdomain(const decomposition::Subdomain& subdomain, SubdomainInterface interface, bool isShared,
                     direct::Factorizer& factorizer, const direct::SpdFactor* like = nullptr);

  [[nodiscard]] const SubdomainInterface& interface() const { return interface_; }
  [[nodiscard]] Eigen::Index numRemainders() const { return remainderToCrosspoint_.rows(); }
  [[nodiscard]] Eigen::Index numBoundary() const { return boundaryResponse_.rows(); }
  [[nodiscard]] Eigen::Index numCrosspoints() const { return schurComplement_.rows(); }

  /// K_rr; its kept unknowns are Δ.
  [[nodiscard]] direct::SpdFactor& factor() const { return *factor_; }
  /// Ψ, n_r × n_c; empty where it is not kept.
  [[nodiscard]] const Eigen::MatrixXd& crosspointResponse() const { return crosspointResponse_; }
  /// Ψ_Δ, n_Δ × n_c.
  [[nodiscard]] const Eigen::MatrixXd& boundaryResponse() const { return boundaryResponse_; }
  /// S, n_c × n_c, symmetric positive semidefinite, to the last digit.
  [[nodiscard]] const Eigen::MatrixXd& schurComplement() const { return schurComplement_; }
  /// K_rc, n_r × n_c.
  [[nodiscard]] const decomposition::SparseMatrix& remainderToCrosspoint() const {
    return remainderToCrosspoint_;
  }

private:
  SubdomainInterface interface_;
  std::unique_ptr<direct::SpdFactor> factor_;
  decomposition::SparseMatrix remainderToCrosspoint_;
  Eigen::MatrixXd crosspointResponse_, boundaryResponse_, schurComplement_;
};

} // namespace epafi::fetidp
