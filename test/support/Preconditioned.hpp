#pragma once

/// F and its preconditioner with what dense algebra says of both.

#include "DenseProblem.hpp"

#include "epafi/fetidp/operator/DualOperator.hpp"
#include "epafi/fetidp/precondition/DualPreconditioner.hpp"

#include <string>
#include <vector>

namespace epafi::fetidp {

using Type = PreconditionerParameters::Type;
using Scaling = PreconditionerParameters::Scaling;

/// A communicator of this rank alone: every rank solves the whole problem by itself.
RCP<const Comm> thisRankOnly();

struct Preconditioned {
  explicit Preconditioned(const scene::Scene& scene, const PreconditionerParameters& parameters = {},
                          const RCP<const Comm>& comm = world());

  model::Decomposition decomposition;
  const DecomposedProblem& problem;
  std::shared_ptr<GeneralizedInverse> inverse;
  DualOperator f;
  DualPreconditioner m;
};

/// G̃ᵀ = B̄R, n_λ × k, on every rank. Collective.
Eigen::MatrixXd kernelRows(const DecomposedProblem& problem);
/// Orthonormal columns that span what the given ones (n × k, of full rank) are orthogonal to.
Eigen::MatrixXd kernelOf(const Eigen::MatrixXd& columns);

/// Eigenvalues of MF on Ker G, ascending: λ with F x = λ M⁻¹ x there. Rows of B that touch nothing are left
/// out. Collective.
Eigen::VectorXd spectrum(const Preconditioned& preconditioned);
/// Condition number of MF on Ker G: its largest over its smallest eigenvalue. Collective.
double conditionNumber(const Preconditioned& preconditioned);

/// Eigenvalues of D^(−1/2) A D^(−1/2), D the diagonal of A (which must be positive), ascending: what is left
/// of a spectrum when units are taken out.
Eigen::VectorXd scaledSpectrum(const Eigen::MatrixXd& symmetric);
/// ‖D^(−1/2) (A − Aᵀ) D^(−1/2)‖, the largest entry: asymmetry without units.
double scaledAsymmetry(const Eigen::MatrixXd& matrix);

/// Scenes that preconditioners find hard: conductivities that jump by 10^±6 between bodies, or between
/// regions along the cut; contact that ends at supports of one body or of both, contacts that meet in a
/// corner, three bodies in a row.
std::vector<ContactCase> hardCases();
/// Conductivities that jump by 10^±6 inside subdomains, METIS parts among them.
std::vector<ContactCase> jumpsInside();

/// Lumped and dirichlet with both scalings, in the precision asked for.
std::vector<PreconditionerParameters> allPreconditioners(bool isSingle);

} // namespace epafi::fetidp
