#include "epafi/fetidp/solve/DualProblem.hpp"

#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

DualProblem::DualProblem(const decomposition::DecomposedProblem& problem,
                         const decomposition::ProblemData& data,
                         const std::shared_ptr<GeneralizedInverse>& inverse, const DualParameters& parameters,
                         const RunFacts& run)
    : problem_(problem), inverse_(inverse), parameters_(parameters),
      kernelEntries_(kernelConstraint(problem)), facts_(factsOf(problem, run)),
      plan_(fetidp::plan(facts_, parameters)),
      operators_(makeDualOperators(problem, data, plan_, inverse, kernelEntries_, parameters)) {
  facts_.isCorrected = !operators_.corrected.is_null();
  facts_.hasDependentRows = operators_.hasDependentRows;
  plan_ = fetidp::plan(facts_, parameters);
}

RCP<Vector> DualProblem::startFrom(const decomposition::ProblemData& data,
                                   std::span<const Eigen::VectorXd> displacement) const {
  if (operators_.dualPreconditioner.is_null() ||
      parameters_.preconditioner.type != PreconditionerParameters::Type::dirichlet)
    return Teuchos::null;
  SubdomainVectors given;
  for (std::size_t s = 0; s < problem_.subdomains.size(); ++s)
    given.emplace_back(decomposition::unknownsOf(problem_.subdomains[s], displacement[s]));
  RCP<Vector> lambda = operators_.dualPreconditioner->multipliersOf(problem_, data, given);
  feasibleForces(data, *lambda)->project(*lambda);
  return lambda;
}

} // namespace epafi::fetidp
