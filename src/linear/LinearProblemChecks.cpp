#include "epafi/linear/LinearProblemChecks.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/FiniteData.hpp"

namespace epafi::linear {

const decomposition::DecomposedProblem& requireLinearProblem(const UnassembledOperator& k,
                                                             const std::string& what) {
  const decomposition::DecomposedProblem& problem = k.problem();
  if (problem.numInequalities > 0)
    throw InputError(what + " solves linear problems, but this one has " +
                     std::to_string(problem.numInequalities) +
                     " rows of contact; leave them out, or solve it by ContactSolver");
  std::string names;
  for (const decomposition::Body& body : problem.bodies)
    if (body.kernelDimension > 0)
      names += (names.empty() ? "'" : ", '") + body.name + "'";
  if (!names.empty())
    throw SolvabilityError(SolvabilityError::Kind::notUnique,
                           "nothing holds " + names + ": K is singular, and " + what +
                               " needs it positive definite; add supports, or a small mass term");
  fetidp::requireFiniteMatrices(problem);
  return problem;
}

} // namespace epafi::linear
