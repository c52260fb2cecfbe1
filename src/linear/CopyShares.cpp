#include "epafi/linear/CopyShares.hpp"

namespace epafi::linear {

CopyShares::CopyShares(const decomposition::DecomposedProblem& problem, const UnknownExchange& exchange,
                       fetidp::PreconditionerParameters::Scaling scaling) {
  SubdomainVectors weights, totals;
  for (const decomposition::Subdomain& subdomain : problem.subdomains)
    if (scaling == fetidp::PreconditionerParameters::Scaling::stiffness)
      weights.emplace_back(subdomain.stiffness->diagonal());
    else
      weights.emplace_back(Eigen::VectorXd::Ones(subdomain.stiffness->rows()));
  MultiVector sum(exchange.map(), 1);
  exchange.sum(weights, sum);
  exchange.toSubdomains(sum, totals);
  for (std::size_t s = 0; s < weights.size(); ++s)
    shares_.emplace_back(weights[s].col(0).cwiseQuotient(totals[s].col(0)));
}

void CopyShares::scale(SubdomainVectors& u) const {
  for (std::size_t s = 0; s < u.size(); ++s)
    u[s].array().colwise() *= shares_[s].array();
}

} // namespace epafi::linear
