#include "Cones.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace epafi::test {

bool isClear(double value, const char* of) {
  if (!(value < roundOff) && !(value > clear))
    throw Uncertain{of};
  return value > clear;
}

Eigen::MatrixXd nullSpace(const Eigen::MatrixXd& matrix, const char* of) {
  const Eigen::Index n = matrix.cols();
  if (n == 0 || matrix.rows() == 0)
    return Eigen::MatrixXd::Identity(n, n);
  const direct::RightSingular svd = direct::rightSingularOf(matrix);
  Eigen::Index rank = 0;
  for (const double value : svd.values)
    rank += isClear(value, of) ? 1 : 0;
  return svd.vectors.rightCols(n - rank);
}

Eigen::VectorXd imbalance(const Eigen::MatrixXd& a, const Eigen::VectorXd& target) {
  const Eigen::Index n = a.cols();
  std::vector<Eigen::Index> free; // entries of x that are not 0
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n), residual = target;
  const double size = 1e-14 * target.norm();
  for (Eigen::Index step = 0; step < 10 * n + 10; ++step) {
    Eigen::VectorXd gain = a.transpose() * residual;
    for (const Eigen::Index i : free)
      gain[i] = 0;
    Eigen::Index next = 0;
    if (n == 0 || gain.maxCoeff(&next) <= size || static_cast<Eigen::Index>(free.size()) == n)
      break;
    free.push_back(next);
    while (true) {
      const Eigen::VectorXd y = direct::leastSquares(a(allOf, free), target);
      double share = 1;
      Eigen::Index blocking = -1;
      for (std::size_t k = 0; k < free.size(); ++k)
        if (const double from = x[free[k]], to = y[k];
            to <= 0 && (blocking < 0 || from < share * (from - to))) {
          share = from > to ? from / (from - to) : 0.0;
          blocking = free[k];
        }
      for (std::size_t k = 0; k < free.size(); ++k)
        x[free[k]] += share * (y[k] - x[free[k]]);
      if (blocking < 0)
        break;
      std::erase_if(free, [&](Eigen::Index i) {
        const bool isZero = i == blocking || x[i] <= 0;
        x[i] = isZero ? 0.0 : x[i];
        return isZero;
      });
      if (free.empty())
        break;
    }
    const Eigen::VectorXd now = target - a * x;
    if (!(now.norm() < residual.norm()))
      return now.norm() < residual.norm() ? now : residual;
    residual = now;
  }
  return residual;
}

namespace {

/// Length of the shortest x with Cx ≤ s, Cx = s; infinite if there is none. By least distance programming, in
/// the space of the rows.
double shortest(const Eigen::MatrixXd& c, const Eigen::VectorXd& s, Eigen::Index numInequalities) {
  const Eigen::Index rank = std::min(c.rows(), c.cols()), numEqualities = c.rows() - numInequalities;
  const Eigen::MatrixXd rows = direct::triangularFactor(c.transpose());
  Eigen::MatrixXd all(rank + 1, c.rows() + numEqualities);
  all.topLeftCorner(rank, c.rows()) = -rows;
  all.row(rank).head(c.rows()) = -s.transpose();
  all.rightCols(numEqualities) = -all.middleCols(numInequalities, numEqualities);
  const double left = imbalance(all, Eigen::VectorXd::Unit(rank + 1, rank)).norm(); // (1 + ‖x‖²)^-½
  return left > 1e-7 ? std::sqrt(std::max(0.0, 1 / (left * left) - 1))
                     : std::numeric_limits<double>::infinity();
}

} // namespace

bool isFeasible(const Eigen::MatrixXd& c, const Eigen::VectorXd& s, Eigen::Index numInequalities) {
  const Eigen::VectorXd bonds = s.tail(s.size() - numInequalities);
  if (bonds.isZero(0) && (numInequalities == 0 || s.head(numInequalities).minCoeff() >= 0))
    return true;
  constexpr double farthest = 1e2;
  if (shortest(c, s, numInequalities) <= farthest)
    return true;
  // With a little more room, a bond being two inequalities:
  const Eigen::Index numEqualities = c.rows() - numInequalities;
  Eigen::MatrixXd both(c.rows() + numEqualities, c.cols());
  both << c, -c.bottomRows(numEqualities);
  Eigen::VectorXd room(both.rows());
  room << s, -bonds;
  if (shortest(both, room.array() + clear, both.rows()) <= 1e4 * farthest)
    throw Uncertain{"room"};
  return false;
}

bool isPointed(const Eigen::MatrixXd& a, const Eigen::MatrixXd& e) {
  const Eigen::MatrixXd free = nullSpace(e, "what forces hold");
  if (free.cols() == 0)
    return true;
  Eigen::MatrixXd directions = (a * free).transpose();
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < directions.cols(); ++i)
    if (const double length = directions.col(i).norm(); isClear(length, "what contacts hinder"))
      directions.col(count++) = directions.col(i) / length;
  directions.conservativeResize(Eigen::NoChange, count);
  if (count == 0 || nullSpace(directions.transpose(), "what contacts hinder").cols() > 0)
    return false;
  return !isClear(imbalance(directions, -directions.rowwise().mean()).norm(), "opposition of contacts");
}

} // namespace epafi::test
