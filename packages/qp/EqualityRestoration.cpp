#include "epafi/qp/EqualityRestoration.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <vector>

namespace epafi::qp {
namespace {

/// Distance to the nearer bound; `unbounded` where there is none.
void fillWeights(const Bounds& bounds, const Vector& x, double unbounded, Vector& weights) {
  const auto values = localData(x);
  const auto w = localDataNonConst(weights);
  const Bounds::Local local = bounds.local();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Bounds::Interval interval = local[i];
    w[i] = std::max(0.0, std::min({values[i] - interval.lower, interval.upper - values[i], unbounded}));
  }
}

} // namespace

void restoreEquality(const EqualityConstraint& g, const Bounds& bounds, std::span<const double> gx,
                     Vector& x) {
  const int k = g.size();
  const auto numRows = static_cast<std::size_t>(k);
  const Comm& comm = *x.getMap()->getComm();
  Vector weights(x.getMap()), column(x.getMap());
  fillWeights(bounds, x, x.normInf(), weights);

  std::vector<AccurateSum> sums(numRows * numRows);
  std::vector<double> gram(numRows * numRows, 0.0), unit(numRows, 0.0); // GWGᵀ
  for (std::size_t j = 0; j < numRows; ++j) {
    unit.assign(numRows, 0.0);
    unit[j] = 1.0;
    column.putScalar(0.0);
    g.addTransposedProduct(unit, 1.0, column);
    column.elementWiseMultiply(1.0, weights, column, 0.0);
    g.addLocalProduct(column, std::span(sums).subspan(j * numRows, numRows));
  }
  sumOverRanks(comm, sums);
  for (std::size_t j = 0; j < numRows; ++j)
    g.finishProduct(std::span(sums).subspan(j * numRows, numRows),
                    std::span(gram).subspan(j * numRows, numRows));

  std::vector<double> solution(gx.begin(), gx.end());
  int info = 0;
  Teuchos::LAPACK<int, double>().POSV('L', k, 1, gram.data(), k, solution.data(), k, &info);
  if (info != 0)
    return;
  column.putScalar(0.0);
  g.addTransposedProduct(solution, -1.0, column);
  if (!(column.normInf() < 1.0)) // |δ_i| < W_i: no bound is crossed
    return;
  column.elementWiseMultiply(1.0, weights, column, 0.0);
  x.update(1.0, column, 1.0);
}

} // namespace epafi::qp
