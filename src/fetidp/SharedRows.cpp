#include "epafi/fetidp/SharedRows.hpp"

#include "epafi/fetidp/MultiplierExchange.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace epafi::fetidp {

std::vector<LocalOrdinal> sharedContactRows(const decomposition::DecomposedProblem& problem) {
  MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  const std::span<double> isShared = exchange.values();
  std::fill(isShared.begin(), isShared.end(), 0.0);
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    std::map<int, std::vector<int>> rowsOf; // of an unknown
    for (const decomposition::ConstraintEntry& entry : subdomain.constraint)
      if (entry.coefficient != 0 &&
          problem.multiplierGhostMap->getGlobalElement(entry.multiplier) < problem.numInequalities)
        rowsOf[entry.unknown].push_back(entry.multiplier);
    for (auto& [unknown, rows] : rowsOf) {
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      for (const int row : rows)
        if (rows.size() > 1)
          isShared[static_cast<std::size_t>(row)] = 1;
    }
  }
  Vector owned(problem.multiplierMap);
  exchange.sumToOwners(owned);
  std::vector<LocalOrdinal> result;
  const auto values = owned.getData();
  for (Teuchos_Ordinal row = 0; row < values.size(); ++row)
    if (values[row] > 0)
      result.push_back(static_cast<LocalOrdinal>(row));
  return result;
}

ShiftedPreconditioner::ShiftedPreconditioner(RCP<const Operator> m, std::vector<LocalOrdinal> rows,
                                             double shift)
    : m_(std::move(m)), rows_(std::move(rows)), shift_(shift) {}

void ShiftedPreconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
                                  double beta) const {
  m_->apply(x, y, mode, alpha, beta);
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto given = x.getData(column);
    const auto result = y.getDataNonConst(column);
    for (const LocalOrdinal row : rows_)
      result[row] += alpha * shift_ * given[row];
  }
}

} // namespace epafi::fetidp
