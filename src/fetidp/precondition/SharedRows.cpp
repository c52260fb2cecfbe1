#include "epafi/fetidp/precondition/SharedRows.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace epafi::fetidp {

namespace {

/// Entries of its own must make up this share of a row, Σb² over them beside Σb²: less is another row but for
/// round-off.
constexpr double leastOwnShare = 0.1;

} // namespace

OwnEntries ownEntries(const decomposition::DecomposedProblem& problem, const Import& plan) {
  OwnEntries result;
  MultiVector touched(problem.multiplierGhostMap, 2),
      owned(problem.multiplierMap, 2); // Σb² of own entries, of all
  {
    const auto own = touched.getDataNonConst(0), all = touched.getDataNonConst(1);
    for (const decomposition::Subdomain& subdomain : problem.subdomains) {
      const auto isGluing = [&](const decomposition::ConstraintEntry& entry) {
        return problem.kindOf(entry.multiplier) == decomposition::RowKind::gluing;
      };
      // Of an unknown: rows of contact and ties, of first tangents, of second ones.
      std::vector<std::array<int, 3>> numRows(subdomain.stiffness->rows(), {0, 0, 0});
      for (const decomposition::ConstraintEntry& entry : subdomain.constraint)
        if (entry.coefficient != 0 && !isGluing(entry))
          ++numRows[entry.unknown][problem.tangentOf(entry.multiplier)];
      std::vector<char>& counts = result.counts.emplace_back();
      for (const decomposition::ConstraintEntry& entry : subdomain.constraint) {
        const double square = entry.coefficient * entry.coefficient;
        counts.push_back(isGluing(entry) || *std::ranges::max_element(numRows[entry.unknown]) == 1 ? 1 : 0);
        all[entry.multiplier] += square;
        own[entry.multiplier] += counts.back() != 0 ? square : 0.0;
      }
    }
  }
  owned.doExport(touched, plan, Tpetra::ADD);
  touched.doImport(owned, plan, Tpetra::INSERT);
  const auto isDependent = [](double own, double all) { return own < leastOwnShare * all; };
  const auto own = touched.getData(0), all = touched.getData(1);
  for (std::size_t s = 0; s < result.counts.size(); ++s)
    for (std::size_t e = 0; e < result.counts[s].size(); ++e)
      if (const int row = problem.subdomains[s].constraint[e].multiplier; isDependent(own[row], all[row]))
        result.counts[s][e] = 1;
  const auto ownHere = owned.getData(0), allHere = owned.getData(1);
  for (LocalOrdinal row = 0; row < ownHere.size(); ++row)
    if (isDependent(ownHere[row], allHere[row]))
      result.dependent.push_back(row);
  return result;
}

RCP<Vector> sizesOfRows(const decomposition::DecomposedProblem& problem, const Import& plan) {
  Vector touched(problem.multiplierGhostMap);
  RCP<Vector> sizes = rcp(new Vector(problem.multiplierMap));
  {
    const auto largest = touched.getDataNonConst();
    for (const decomposition::Subdomain& subdomain : problem.subdomains)
      for (const decomposition::ConstraintEntry& entry : subdomain.constraint)
        largest[entry.multiplier] = std::max(largest[entry.multiplier], std::abs(entry.coefficient));
  }
  sizes->doExport(touched, plan, Tpetra::ABSMAX);
  const auto values = sizes->getDataNonConst();
  for (LocalOrdinal row = 0; row < values.size(); ++row)
    if (values[row] == 0 ||
        problem.kindOf(decomposition::OwnedMultiplier(row)) != decomposition::RowKind::gluing)
      values[row] = 1;
  return sizes;
}

ShiftedPreconditioner::ShiftedPreconditioner(RCP<const Operator> m, std::vector<LocalOrdinal> rows,
                                             double shift)
    : SymmetricOperator(m->getDomainMap()), m_(std::move(m)), rows_(std::move(rows)), shift_(shift) {}

void ShiftedPreconditioner::multiply(const MultiVector& x, MultiVector& y) const {
  m_->apply(x, y);
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto given = x.getData(column);
    const auto result = y.getDataNonConst(column);
    for (const LocalOrdinal row : rows_)
      result[row] += shift_ * given[row];
  }
}

} // namespace epafi::fetidp
