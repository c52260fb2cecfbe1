#include "epafi/fetidp/GeneralizedInverse.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>

namespace epafi::fetidp {

GeneralizedInverse::GeneralizedInverse(const decomposition::DecomposedProblem& problem,
                                       const DirectSolvers& solvers) {
  collectively(*problem.comm, [&] {
    subdomains_.reserve(problem.subdomains.size());
    for (const auto& subdomain : problem.subdomains)
      subdomains_.emplace_back(subdomain, solvers.subdomains);
  });
  coarseProblem_ = std::make_unique<CoarseProblem>(problem, subdomains_, solvers.coarse);
  coarse_.resize(coarseProblem_->size());
  coarseSums_.resize(static_cast<std::size_t>(coarse_.size()));
}

void GeneralizedInverse::applyDual(std::span<const double> lambda, std::span<double> result) {
  std::fill(result.begin(), result.end(), 0.0);
  std::fill(coarseSums_.begin(), coarseSums_.end(), AccurateSum());
  for (SubdomainSolver& subdomain : subdomains_)
    subdomain.applyFlexibility(lambda, coarseSums_); // B_r K_rr⁻¹ B_rᵀ λ, kept, and z = Σ L_cᵀ Wᵀ λ
  coarseProblem_->solve(coarseSums_, coarse_);       // x_c = S_cc⁺ z
  for (const SubdomainSolver& subdomain : subdomains_)
    subdomain.applyCoupling(coarse_, result); // Σ B_r K_rr⁻¹ B_rᵀ λ + W L_c x_c
}

void GeneralizedInverse::apply(const SubdomainVectors& b, SubdomainVectors& u) {
  std::fill(coarseSums_.begin(), coarseSums_.end(), AccurateSum());
  for (std::size_t s = 0; s < subdomains_.size(); ++s)
    subdomains_[s].eliminate(b[s], coarseSums_);
  coarseProblem_->solve(coarseSums_, coarse_);
  u.resize(subdomains_.size());
  for (std::size_t s = 0; s < subdomains_.size(); ++s)
    subdomains_[s].substitute(coarse_, u[s]);
}

void GeneralizedInverse::subtractForces(std::span<const double> lambda, SubdomainVectors& b) const {
  for (std::size_t s = 0; s < subdomains_.size(); ++s)
    subdomains_[s].subtractForces(lambda, b[s]);
}

void GeneralizedInverse::constraint(const SubdomainVectors& u, std::span<double> result) const {
  std::fill(result.begin(), result.end(), 0.0);
  for (std::size_t s = 0; s < subdomains_.size(); ++s)
    subdomains_[s].addConstraint(u[s], result);
}

std::size_t GeneralizedInverse::factorBytes() const {
  std::size_t bytes = coarseProblem_->factorBytes();
  for (const SubdomainSolver& subdomain : subdomains_)
    bytes += subdomain.factorBytes();
  return bytes;
}

} // namespace epafi::fetidp
