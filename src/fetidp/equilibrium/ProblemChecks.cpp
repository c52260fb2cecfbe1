#include "epafi/fetidp/equilibrium/ProblemChecks.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <string>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::Subdomain;

/// "contact row 3", counted among its own kind.
[[nodiscard]] std::string nameOf(const DecomposedProblem& problem, decomposition::MultiplierNumber row) {
  constexpr const char* names[] = {"contact", "friction", "tied", "gluing"};
  const int kind = static_cast<int>(problem.kindOf(row));
  const GlobalOrdinal first[] = {0, problem.numInequalities, problem.firstTie(),
                                 problem.firstTie() + problem.numTies};
  return std::string(names[kind]) + " row " + std::to_string(row - first[kind]);
}

[[nodiscard]] std::string bodyOf(const DecomposedProblem& problem, const Subdomain& subdomain) {
  return "body '" + problem.bodies[subdomain.body].name + "'";
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
    if (!std::isfinite(entry.coefficient))
      throw InputError(nameOf(problem, problem.numberOf(entry.multiplier)) +
                       " has a coefficient in subdomain " + std::to_string(subdomain.number) + " of " +
                       bodyOf(problem, subdomain) +
                       " that is not a finite number; check what is entered in B");
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

void requireOwnData(const DecomposedProblem& problem, const decomposition::ProblemData& data) {
  collectively(*problem.comm, [&] {
    const auto own = data.subdomains();
    bool fits = !data.isEmpty() && own.size() == problem.subdomains.size() &&
                data.gap().getMap()->locallySameAs(*problem.multiplierMap);
    for (std::size_t s = 0; fits && s < own.size(); ++s)
      fits = own[s].load.size() == problem.subdomains[s].stiffness->rows() &&
             own[s].prescribed.size() == problem.numPositions(problem.subdomains[s]);
    if (!fits)
      throw InputError(
          "the loads and gaps are not those of the problem that is set up; after a change of its "
          "rows take them anew");
  });
}

void requireFiniteData(const DecomposedProblem& problem, const decomposition::ProblemData& data) {
  collectively(*problem.comm, [&] {
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
      if (!data.subdomains()[s].rightHandSide().allFinite())
        throw InputError("the load of " + bodyOf(problem, problem.subdomains[s]) +
                         " has an entry in subdomain " + std::to_string(problem.subdomains[s].number) +
                         " that is not a finite number; check its loads and supports");
    const auto gaps = data.gap().getData();
    for (LocalOrdinal row = 0; row < gaps.size(); ++row)
      if (!std::isfinite(gaps[row]))
        throw InputError("the gap of " +
                         nameOf(problem, problem.numberOf(decomposition::OwnedMultiplier(row))) +
                         " is not a finite number; check the gaps");
  });
}

} // namespace epafi::fetidp
