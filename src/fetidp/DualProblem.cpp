#include "epafi/fetidp/DualProblem.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>

namespace epafi::fetidp {

DualProblem::DualProblem(const decomposition::DecomposedProblem& problem,
                         const std::shared_ptr<GeneralizedInverse>& inverse, const DualParameters& parameters)
    : problem_(problem), inverse_(inverse), parameters_(parameters),
      choice_(chosenAlgorithm(problem, parameters)), kernelEntries_(kernelConstraint(problem)),
      operators_(makeDualOperators(problem, choice_.algorithm, inverse, kernelEntries_, parameters)) {}

RCP<Vector> DualProblem::startFrom(std::span<const Eigen::VectorXd> displacement) const {
  if (operators_.dualPreconditioner.is_null() ||
      parameters_.preconditioner.type != PreconditionerParameters::Type::dirichlet)
    return Teuchos::null;
  SubdomainVectors given;
  for (std::size_t s = 0; s < problem_.subdomains.size(); ++s)
    given.emplace_back(decomposition::unknownsOf(problem_.subdomains[s], displacement[s]));
  const RCP<Vector> lambda = operators_.dualPreconditioner->multipliersOf(problem_, given);
  const auto values = lambda->getDataNonConst();
  for (LocalOrdinal row = 0; row < values.size(); ++row)
    if (problem_.kindOf(decomposition::OwnedMultiplier(row)) == decomposition::RowKind::contact)
      values[row] = std::max(values[row], 0.0);
  return lambda;
}

} // namespace epafi::fetidp
