#include "epafi/fetidp/SharedRows.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <map>
#include <set>
#include <utility>

namespace epafi::fetidp {

std::vector<LocalOrdinal> sharedContactRows(const decomposition::DecomposedProblem& problem) {
  Tpetra::Vector<int> touched(problem.multiplierGhostMap), owned(problem.multiplierMap);
  const auto isShared = touched.getDataNonConst();
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    std::map<int, std::set<int>> rowsOf; // of an unknown
    for (const decomposition::ConstraintEntry& entry : subdomain.constraint)
      if (entry.coefficient != 0 && problem.kindOf(entry.multiplier) == decomposition::RowKind::contact)
        rowsOf[entry.unknown].insert(entry.multiplier);
    for (const auto& [unknown, rows] : rowsOf)
      for (const int row : rows)
        if (rows.size() > 1)
          isShared[row] = 1;
  }
  owned.doExport(touched, Import(problem.multiplierMap, problem.multiplierGhostMap), Tpetra::ADD);
  std::vector<LocalOrdinal> result;
  const auto values = owned.getData();
  for (Teuchos_Ordinal row = 0; row < values.size(); ++row)
    if (values[row] > 0)
      result.push_back(static_cast<LocalOrdinal>(row));
  return result;
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
