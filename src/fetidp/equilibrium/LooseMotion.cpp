#include "epafi/fetidp/equilibrium/LooseMotion.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/direct/NonNegativeLeastSquares.hpp"
#include "epafi/fetidp/equilibrium/ProblemScales.hpp"

namespace epafi::fetidp {

ShortestMotion shortestMotion(const Eigen::MatrixXd& c, const Eigen::VectorXd& s) {
  const Eigen::Index n = c.rows();
  const double scale = s.size() > 0 && s.lpNorm<Eigen::Infinity>() > 0 ? s.lpNorm<Eigen::Infinity>() : 1.0;
  Eigen::MatrixXd e(n + 1, c.cols());
  e << -c, -s.transpose() / scale;
  const auto dual = direct::nonNegativeLeastSquares(e, Eigen::VectorXd::Unit(n + 1, n));
  const auto isAllowed = [&](const Eigen::VectorXd& x) {
    return (c.transpose() * x - s).maxCoeff() <= 1e-9 * scale;
  };
  if (dual.residual[n] > 0) // round-off of a residual 0 would give anything
    if (const Eigen::VectorXd x = -scale * dual.residual.head(n) / dual.residual[n]; isAllowed(x))
      return {x, {}};
  ShortestMotion none;
  const double least = dual.x.size() > 0 ? ProblemScales::resultant * dual.x.maxCoeff() : 0.0;
  for (Eigen::Index j = 0; j < dual.x.size(); ++j)
    if (dual.x[j] > least)
      none.excluding.push_back(j);
  // a long way along directions that nearly oppose each other: the residual has few digits then
  if (!none.excluding.empty())
    if (const Eigen::VectorXd x =
            direct::leastSquares(c(allOf, none.excluding).transpose(), s(none.excluding));
        isAllowed(x))
      return {x, {}};
  return none;
}

std::optional<Eigen::VectorXd> looseMotion(const Eigen::MatrixXd& directions, const Eigen::VectorXd& room,
                                           Eigen::MatrixXd open, double meets) {
  while (open.cols() > 0) {
    const Eigen::MatrixXd all = open.transpose() * directions;
    std::vector<Eigen::Index> meeting;
    for (Eigen::Index j = 0; j < all.cols(); ++j)
      if (all.col(j).norm() > meets)
        meeting.push_back(j);
    if (meeting.empty())
      return open.col(0);
    const Eigen::MatrixXd met = all(allOf, meeting);
    const ShortestMotion found = shortestMotion(met, room(meeting));
    if (found.x)
      return open * (found.x->norm() > 0 ? *found.x : Eigen::VectorXd::Unit(open.cols(), 0));
    if (found.excluding.empty())
      return std::nullopt;
    const Eigen::MatrixXd excluding = met(allOf, found.excluding);
    const direct::SymmetricEigen spectrum = direct::eigenOf(excluding * excluding.transpose());
    open = (open *
            spectrum.vectors.leftCols(spectrum.numUpTo(ProblemScales::roundOff * spectrum.values.maxCoeff())))
               .eval();
  }
  return std::nullopt;
}

} // namespace epafi::fetidp
