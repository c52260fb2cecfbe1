#include "epafi/linear/UnassembledOperator.hpp"

#include <Eigen/SparseCore>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace epafi::linear {
namespace {

using decomposition::Average;
using decomposition::SparseMatrix;
using decomposition::Subdomain;

/// T⁻¹: ũ = T⁻¹ u.
SparseMatrix unknownsFromValues(const Subdomain& subdomain) {
  std::vector<Eigen::Triplet<double, int>> entries;
  std::vector<char> isAveraged(subdomain.unknownPosition.size(), 0);
  for (const Average& average : subdomain.averages) {
    std::vector<int> edge = average.others;
    edge.push_back(average.carrier);
    const double share = 1 / static_cast<double>(edge.size());
    for (const int row : edge) {
      isAveraged[row] = 1;
      const double sign = row == average.carrier ? 1 : -1;
      for (const int column : edge)
        entries.emplace_back(row, column, sign * share); // a, or −a
      if (row != average.carrier)
        entries.emplace_back(row, row, 1.0);
    }
  }
  for (std::size_t i = 0; i < isAveraged.size(); ++i)
    if (isAveraged[i] == 0)
      entries.emplace_back(i, i, 1.0);
  const Eigen::Index n = isAveraged.size();
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// T⁻ᵀ K^s T⁻¹, K^s on values of nodes; what the averages filled in is round-off and is left out.
SparseMatrix onValues(const Subdomain& subdomain) {
  const SparseMatrix t = unknownsFromValues(subdomain);
  SparseMatrix k = t.transpose() * *subdomain.stiffness * t;
  if (k.nonZeros() == 0)
    return k;
  const double largest = k.coeffs().cwiseAbs().maxCoeff();
  k.prune([largest](int row, int column, double value) {
    return row == column || std::abs(value) > 1e-13 * largest;
  });
  return k;
}

/// K^s on values of nodes.
std::shared_ptr<const SparseMatrix> matrixOf(const Subdomain& subdomain) {
  return subdomain.averages.empty() ? subdomain.stiffness
                                    : std::make_shared<const SparseMatrix>(onValues(subdomain));
}

/// An empty matrix with room for every entry of every copy of a row. Collective.
RCP<CrsMatrix> withRoomFor(const std::vector<std::shared_ptr<const SparseMatrix>>& matrices,
                           const UnknownExchange& exchange) {
  SubdomainVectors counts;
  for (const auto& local : matrices) {
    Eigen::MatrixXd& entries = counts.emplace_back(local->cols(), 1);
    for (Eigen::Index j = 0; j < local->cols(); ++j)
      entries(j) = local->outerIndexPtr()[j + 1] - local->outerIndexPtr()[j];
  }
  MultiVector sums(exchange.map(), 1);
  exchange.sum(counts, sums);
  std::vector<std::size_t> room;
  for (const double entries : sums.getData(0))
    room.push_back(std::max<std::size_t>(1, static_cast<std::size_t>(entries)));
  return rcp(new CrsMatrix(exchange.map(), Teuchos::arrayViewFromVector(room)));
}

} // namespace

RCP<CrsMatrix> assembled(const UnassembledOperator& k) {
  std::vector<std::shared_ptr<const SparseMatrix>> matrices;
  for (const Subdomain& subdomain : k.problem().subdomains)
    matrices.push_back(matrixOf(subdomain));
  const RCP<CrsMatrix> matrix = withRoomFor(matrices, k.exchange());
  std::vector<GlobalOrdinal> columns;
  for (std::size_t s = 0; s < matrices.size(); ++s) {
    const SparseMatrix& local = *matrices[s];
    const std::vector<GlobalOrdinal>& numbers = k.unknowns()[s];
    for (int j = 0; j < local.outerSize(); ++j) { // symmetric: column j is row j
      columns.clear();
      const int first = local.outerIndexPtr()[j], size = local.outerIndexPtr()[j + 1] - first;
      for (int i = 0; i < size; ++i)
        columns.push_back(numbers[local.innerIndexPtr()[first + i]]);
      matrix->insertGlobalValues(numbers[j], Teuchos::arrayViewFromVector(columns),
                                 Teuchos::arrayView(local.valuePtr() + first, size));
    }
  }
  for (const LocalOrdinal row : k.identityRows()) {
    const GlobalOrdinal number = k.getRangeMap()->getGlobalElement(row);
    matrix->insertGlobalValues(number, Teuchos::tuple(number), Teuchos::tuple(1.0));
  }
  matrix->fillComplete();
  return matrix;
}

} // namespace epafi::linear
