#include "epafi/linear/LinearProblemChecks.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/equilibrium/ProblemChecks.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"
#include "epafi/fetidp/precondition/SharedRows.hpp"
#include "epafi/linear/NodalBasis.hpp"
#include "epafi/qp/operators/StartVector.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <string>

namespace epafi::linear {
namespace {

using decomposition::DecomposedProblem;

/// A function of the numbers, with values that hardly two share, in the unknowns ũ of each subdomain.
SubdomainVectors sample(const DecomposedProblem& problem, const GlobalUnknowns& unknowns) {
  SubdomainVectors u;
  for (std::size_t s = 0; s < unknowns.size(); ++s) {
    Eigen::MatrixXd& values = u.emplace_back(unknowns[s].size(), 1);
    for (std::size_t i = 0; i < unknowns[s].size(); ++i)
      values(i) = qp::pseudoRandom(unknowns[s][i]);
    toUnknowns(problem.subdomains[s], values);
  }
  return u;
}

constexpr double roundOff = 1e-10; ///< of means of numbers in (−1, 1)

/// The gluing rows' jumps B_E u; throws at the first that is none.
void requireNoJump(const DecomposedProblem& problem, const GlobalUnknowns& unknowns,
                   const SubdomainVectors& u) {
  fetidp::MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  const auto jumps = exchange.zeros();
  for (std::size_t s = 0; s < u.size(); ++s)
    for (const auto& entry : problem.subdomains[s].constraint)
      jumps[entry.multiplier] += entry.coefficient * u[s](entry.unknown);
  MultiVector owned(problem.multiplierMap, 1);
  exchange.sumToOwners(owned);
  const RCP<const Vector> sizes =
      fetidp::sizesOfRows(problem, Import(problem.multiplierMap, problem.multiplierGhostMap));
  {
    const auto jump = owned.getDataNonConst(0);
    const auto size = sizes->getData();
    for (LocalOrdinal row = 0; row < jump.size(); ++row)
      jump[row] /= size[row];
  }
  const auto total = exchange.toSubdomains(owned);
  collectively(*problem.comm, [&] {
    for (std::size_t s = 0; s < u.size(); ++s)
      for (const auto& entry : problem.subdomains[s].constraint) {
        const std::size_t multiplier = entry.multiplier;
        if (problem.kindOf(entry.multiplier) == decomposition::RowKind::gluing &&
            std::abs(total[multiplier]) > roundOff)
          throw InputError("unknown " + std::to_string(entry.unknown) + " of subdomain " +
                           std::to_string(problem.subdomains[s].number) + ", with the global number " +
                           std::to_string(unknowns[s][entry.unknown]) + ", is glued by row " +
                           std::to_string(problem.numberOf(entry.multiplier)) +
                           " to one with another number; copies that are glued must have the same");
      }
  });
}

/// That copies of a crosspoint value agree.
void requireCommonCrosspoints(const DecomposedProblem& problem, const SubdomainVectors& u) {
  GlobalUnknowns crosspoints;
  SubdomainVectors values, ones;
  for (std::size_t s = 0; s < u.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    crosspoints.emplace_back(subdomain.crosspointIndices.begin(), subdomain.crosspointIndices.end());
    values.emplace_back(u[s](subdomain.crosspointUnknowns, 0));
    ones.emplace_back(Eigen::MatrixXd::Ones(values.back().rows(), 1));
  }
  const UnknownExchange exchange(problem.crosspointMap, crosspoints);
  MultiVector sum(problem.crosspointMap, 1);
  SubdomainVectors totals, copies;
  exchange.sum(values, sum);
  exchange.toSubdomains(sum, totals);
  exchange.sum(ones, sum);
  exchange.toSubdomains(sum, copies);
  collectively(*problem.comm, [&] {
    for (std::size_t s = 0; s < u.size(); ++s)
      for (Eigen::Index i = 0; i < values[s].rows(); ++i)
        if (std::abs(values[s](i) - totals[s](i) / copies[s](i)) > roundOff)
          throw InputError("crosspoint value " + std::to_string(problem.subdomains[s].crosspointIndices[i]) +
                           " has copies with different global numbers, one of them in subdomain " +
                           std::to_string(problem.subdomains[s].number) +
                           "; copies of a crosspoint must have the same");
  });
}

} // namespace

void requireJoinedCopies(const DecomposedProblem& problem, const GlobalUnknowns& unknowns,
                         std::size_t numOthers, const UnknownExchange& exchange) {
  const SubdomainVectors u = sample(problem, unknowns);
  requireNoJump(problem, unknowns, u);
  requireCommonCrosspoints(problem, u);
  const GlobalOrdinal joined = problem.remainderMap->getGlobalNumElements() +
                               problem.crosspointMap->getGlobalNumElements() - problem.numEqualities;
  const GlobalOrdinal numbers = exchange.map()->getGlobalNumElements() -
                                sumOverRanks(*problem.comm, static_cast<GlobalOrdinal>(numOthers));
  if (numbers != joined)
    throw InputError("the unknowns have " + std::to_string(numbers) +
                     " global numbers, but the subdomains, joined by gluing rows and crosspoints, have " +
                     std::to_string(joined) +
                     " unknowns; each number must be one unknown with all its copies");
}

const DecomposedProblem& requireLinearProblem(const UnassembledOperator& k, const std::string& what) {
  const DecomposedProblem& problem = k.problem();
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
