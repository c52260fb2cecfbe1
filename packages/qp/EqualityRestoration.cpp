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

/// 1 where x is free, 0 at a bound.
void fillFree(const Bounds& bounds, const Vector& x, Vector& weights) {
  const auto values = localData(x);
  const auto w = localDataNonConst(weights);
  const Bounds::Local local = bounds.local();
  for (std::size_t i = 0; i < values.size(); ++i)
    w[i] = local[i].isFree(values[i]) ? 1.0 : 0.0;
}

/// Solves GWGᵀ s = r, in place; false if the weights leave G too few columns. One message of k² numbers.
bool solveWeighted(const EqualityConstraint& g, const Vector& weights, std::vector<double>& r) {
  const std::size_t numRows = r.size();
  Vector column(weights.getMap());
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
  sumOverRanks(*weights.getMap()->getComm(), sums);
  for (std::size_t j = 0; j < numRows; ++j)
    g.finishProduct(std::span(sums).subspan(j * numRows, numRows),
                    std::span(gram).subspan(j * numRows, numRows));
  const int k = static_cast<int>(numRows);
  int info = 0;
  Teuchos::LAPACK<int, double>().POSV('L', k, 1, gram.data(), k, r.data(), k, &info);
  return info == 0;
}

} // namespace

void restoreEquality(const EqualityConstraint& g, const Bounds& bounds, std::span<const double> gx,
                     Vector& x) {
  Vector weights(x.getMap()), column(x.getMap());
  fillWeights(bounds, x, x.normInf(), weights);
  std::vector<double> solution(gx.begin(), gx.end());
  if (!solveWeighted(g, weights, solution))
    return;
  g.addTransposedProduct(solution, -1.0, column);
  if (!(column.normInf() < 1.0)) // |δ_i| < W_i: no bound is crossed
    return;
  column.elementWiseMultiply(1.0, weights, column, 0.0);
  x.update(1.0, column, 1.0);
}

std::vector<double> estimateMultiplier(const EqualityConstraint& g, const Bounds& bounds, const Vector& x,
                                       const Vector& gradient) {
  const auto numRows = static_cast<std::size_t>(g.size());
  Vector weights(x.getMap()), free(x.getMap());
  fillFree(bounds, x, weights);
  free.elementWiseMultiply(-1.0, weights, gradient, 0.0); // −φ
  std::vector<AccurateSum> sums(numRows);
  std::vector<double> multiplier(numRows);
  g.addLocalProduct(free, sums);
  sumOverRanks(*x.getMap()->getComm(), sums);
  g.finishProduct(sums, multiplier);
  if (!solveWeighted(g, weights, multiplier))
    multiplier.assign(numRows, 0.0);
  return multiplier;
}

} // namespace epafi::qp
