#include "epafi/qp/constraints/EqualityRestoration.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::qp {
namespace {

/// Solves BWBᵀ s = r, in place; false if the weights leave B too few columns.
bool solveWeighted(const EqualityConstraint& equality, const Vector& weights, std::vector<double>& r) {
  const std::size_t numRows = r.size();
  Vector column(weights.getMap());
  std::vector<double> gram(numRows * numRows), unit(numRows); // BWBᵀ
  for (std::size_t j = 0; j < numRows; ++j) {
    unit.assign(numRows, 0.0);
    unit[j] = 1.0;
    column.putScalar(0.0);
    equality.addTransposedProduct(unit, 1.0, column);
    column.elementWiseMultiply(1.0, weights, column, 0.0);
    equality.product(column, std::span(gram).subspan(j * numRows, numRows));
  }
  const int k = static_cast<int>(numRows);
  int info = 0;
  Teuchos::LAPACK<int, double>().POSV('L', k, 1, gram.data(), k, r.data(), k, &info);
  return info == 0;
}

} // namespace

void restoreEquality(const EqualityConstraint& equality, const ConvexSet& set,
                     std::span<const double> residual, Vector& x) {
  Vector weights(x.getMap()), column(x.getMap());
  set.distanceToBoundary(x, x.normInf(), weights);
  std::vector<double> solution(residual.begin(), residual.end());
  if (!solveWeighted(equality, weights, solution))
    return;
  equality.addTransposedProduct(solution, -1.0, column);
  if (!(column.normInf() < 1.0)) // |δ_i| < W_i: no bound is crossed
    return;
  column.elementWiseMultiply(1.0, weights, column, 0.0);
  x.update(1.0, column, 1.0);
}

std::vector<double> estimateMultiplier(const EqualityConstraint& equality, const ConvexSet& set,
                                       const Vector& x, const Vector& gradient) {
  Vector weights(x.getMap()), free(x.getMap());
  set.freeIndicator(x, weights);
  free.elementWiseMultiply(-1.0, weights, gradient, 0.0); // −φ
  std::vector<double> multiplier(equality.numEntries());
  equality.product(free, multiplier);
  if (!solveWeighted(equality, weights, multiplier))
    multiplier.assign(multiplier.size(), 0.0);
  return multiplier;
}

} // namespace epafi::qp
