#include "epafi/fetidp/ProblemChecks.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/fetidp/MultiplierExchange.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::Subdomain;

[[nodiscard]] std::string bodyOf(const DecomposedProblem& problem, const Subdomain& subdomain) {
  return "body '" + problem.bodies[static_cast<std::size_t>(subdomain.body)].name + "'";
}

void requireFiniteStiffness(const DecomposedProblem& problem, const Subdomain& subdomain) {
  for (int column = 0; column < subdomain.stiffness->outerSize(); ++column)
    for (decomposition::SparseMatrix::InnerIterator entry(*subdomain.stiffness, column); entry; ++entry)
      if (!std::isfinite(entry.value()))
        throw InputError("the stiffness of " + bodyOf(problem, subdomain) + " has an entry in subdomain " +
                         std::to_string(subdomain.number) + " (row " + std::to_string(entry.row()) +
                         ", column " + std::to_string(column) +
                         ") that is not a finite number; check its material and mesh");
}

void requireFiniteRows(const DecomposedProblem& problem, const Subdomain& subdomain) {
  for (const decomposition::ConstraintEntry& entry : subdomain.constraint)
    if (!std::isfinite(entry.coefficient)) {
      constexpr const char* names[] = {"contact", "tied", "gluing"};
      throw InputError(std::string(names[static_cast<int>(problem.kindOf(entry.multiplier))]) + " row " +
                       std::to_string(problem.numberOf(entry.multiplier)) +
                       " has a coefficient in subdomain " + std::to_string(subdomain.number) + " of " +
                       bodyOf(problem, subdomain) +
                       " that is not a finite number; check what is entered in B");
    }
}

} // namespace

void requireFiniteMatrices(const DecomposedProblem& problem) {
  collectively(*problem.comm, [&] {
    const decomposition::SparseMatrix* last = nullptr; // equal subdomains may share one
    for (const Subdomain& subdomain : problem.subdomains) {
      if (subdomain.stiffness.get() != last)
        requireFiniteStiffness(problem, subdomain);
      last = subdomain.stiffness.get();
      requireFiniteRows(problem, subdomain);
    }
  });
}

void requireFiniteData(const DecomposedProblem& problem) {
  collectively(*problem.comm, [&] {
    for (const Subdomain& subdomain : problem.subdomains)
      if (!subdomain.load.allFinite())
        throw InputError("the load of " + bodyOf(problem, subdomain) + " has an entry in subdomain " +
                         std::to_string(subdomain.number) +
                         " that is not a finite number; check its loads and supports");
    const auto gaps = problem.gap->getData();
    for (LocalOrdinal row = 0; row < gaps.size(); ++row)
      if (!std::isfinite(gaps[row]))
        throw InputError("the gap of contact row " +
                         std::to_string(problem.multiplierMap->getGlobalElement(row)) +
                         " is not a finite number; check the gaps");
  });
}

void requireFeasibleGaps(const DecomposedProblem& problem) {
  MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  const std::span<double> magnitude = exchange.zeros();
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      magnitude[static_cast<std::size_t>(entry.multiplier)] += std::abs(entry.coefficient);
  Vector rowSum(problem.multiplierMap);
  exchange.sumToOwners(rowSum);
  // The gaps are differences of prescribed values: what is round-off of these does not overlap.
  double largest = problem.gap->normInf();
  for (const auto& subdomain : problem.subdomains)
    if (subdomain.prescribed.size() > 0)
      largest = std::max(largest, subdomain.prescribed.lpNorm<Eigen::Infinity>());
  const double roundOff = 1e-12 * maxOverRanks(*problem.comm, largest);
  collectively(*problem.comm, [&] {
    const auto sums = rowSum.getData();
    const auto gaps = problem.gap->getData();
    for (Teuchos_Ordinal i = 0; i < sums.size(); ++i)
      if (const bool isContact = problem.kindOf(decomposition::OwnedMultiplier(
                                     static_cast<LocalOrdinal>(i))) == decomposition::RowKind::contact;
          sums[i] == 0 && (isContact ? -gaps[i] : std::abs(gaps[i])) > roundOff)
        throw SolvabilityError(
            SolvabilityError::Kind::noSolution,
            "no solution: contact row " +
                std::to_string(problem.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i))) +
                " lies where supports hold both sides, and they " +
                (isContact ? "overlap by " + text(-gaps[i]) : "are apart by " + text(std::abs(gaps[i]))) +
                "; change a gap, an obstacle or a support");
  });
}

void refuseContradiction(const DecomposedProblem& problem, const Vector& d) {
  constexpr double roundOff = 1e-6; // what MPRGP calls zero curvature leaves as much of a direction
  const Comm& comm = *problem.comm;
  MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  const std::span<const double> values = exchange.toSubdomains(d);
  double left = 0, terms = 0; // of Bᵀd at an unknown
  for (const Subdomain& subdomain : problem.subdomains) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(subdomain.load.size()), size = force;
    for (const decomposition::ConstraintEntry& entry : subdomain.constraint) {
      const double part = entry.coefficient * values[static_cast<std::size_t>(entry.multiplier)];
      force[entry.unknown] += part;
      size[entry.unknown] += std::abs(part);
    }
    if (force.size() > 0) {
      left = std::max(left, force.lpNorm<Eigen::Infinity>());
      terms = std::max(terms, size.lpNorm<Eigen::Infinity>());
    }
  }
  AccurateSum gaps[2]; // cᵀd and the size of its terms
  double tension = 0;
  const auto mine = d.getData(), gap = problem.gap->getData();
  for (Teuchos_Ordinal i = 0; i < mine.size(); ++i) {
    gaps[0].add(gap[i] * mine[i]);
    gaps[1].add(std::abs(gap[i] * mine[i]));
    if (problem.kindOf(decomposition::OwnedMultiplier(static_cast<LocalOrdinal>(i))) ==
        decomposition::RowKind::contact)
      tension = std::max(tension, -mine[i]);
  }
  sumOverRanks(comm, gaps);
  left = maxOverRanks(comm, left);
  terms = maxOverRanks(comm, terms);
  tension = maxOverRanks(comm, tension);
  if (terms > 0 && left <= roundOff * terms && tension <= roundOff * d.normInf() &&
      gaps[0].value() < -1e-6 * gaps[1].value())
    throw SolvabilityError(SolvabilityError::Kind::noSolution,
                           "no solution: contact rows contradict each other, no displacement satisfies them "
                           "all; change a gap, an obstacle or a direction of contact");
}

} // namespace epafi::fetidp
