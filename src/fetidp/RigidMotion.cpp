#include "epafi/fetidp/RigidMotion.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/ContactDirections.hpp"
#include "epafi/fetidp/MotionWords.hpp"
#include "epafi/fetidp/NonNegativeLeastSquares.hpp"

#include <Eigen/Eigenvalues>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <string>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using Rows = std::map<int, Eigen::VectorXd>; // of G̃ᵀ, this rank's, by local index

/// [G̃_A G̃_Aᵀ, G̃_A slack_A] of the rows A that carry force. Collective.
Eigen::MatrixXd normalEquations(const DecomposedProblem& problem, const Rows& rows, const Vector& lambda,
                                const Vector& slack) {
  const Eigen::Index k = problem.kernelDimension;
  const auto force = lambda.getData(), gap = slack.getData();
  Eigen::MatrixXd normal(k, k + 1);
  std::vector<AccurateSum> sums(static_cast<std::size_t>(normal.size()));
  for (const auto& [row, vector] : rows)
    if (force[row] > 0)
      for (Eigen::Index i = 0; i < k; ++i)
        for (Eigen::Index j = 0; j <= k; ++j)
          sums[static_cast<std::size_t>(i + k * j)].add(vector[i] * (j < k ? vector[j] : gap[row]));
  sumOverRanks(*problem.comm, sums);
  for (std::size_t i = 0; i < sums.size(); ++i)
    normal.data()[i] = sums[i].value();
  return normal;
}

/// What the contacts allow: directionsᵀβ ≤ room, one column a distinct direction.
struct Room {
  Eigen::MatrixXd directions; ///< k × (as many as differ)
  Eigen::VectorXd room;
};

/// Collective.
Room roomOf(const DecomposedProblem& problem, const Rows& rows, const Vector& slack,
            const Eigen::VectorXd& alpha) {
  const auto gap = slack.getData();
  DistinctDirections distinct(problem.kernelDimension);
  for (const auto& [row, vector] : rows)
    distinct.add(vector, gap[row] - vector.dot(alpha));
  distinct.gather(*problem.comm);
  return {distinct.matrix(), distinct.values()};
}

/// Shortest x with Cᵀx ≤ s (to 1e-9), or if there is none the columns of C that exclude it: those that forces y ≥ 0 with
/// Cy = 0, yᵀs < 0 act along (Lawson, Hanson, *Solving Least Squares Problems*, 1974, ch. 23.4: least distance
/// programming).
struct Shortest {
  std::optional<Eigen::VectorXd> x;
  std::vector<Eigen::Index> excluding;
};

Shortest shortest(const Eigen::MatrixXd& c, const Eigen::VectorXd& s) {
  const Eigen::Index n = c.rows();
  Eigen::MatrixXd e(n + 1, c.cols());
  e << -c, -s.transpose();
  const NonNegativeSolution dual = nonNegativeLeastSquares(e, Eigen::VectorXd::Unit(n + 1, n));
  Shortest result;
  if (dual.residual[n] > 0) { // round-off of a residual 0 would give anything
    const Eigen::VectorXd x = -dual.residual.head(n) / dual.residual[n];
    if ((c.transpose() * x - s).maxCoeff() <= 1e-9)
      result.x = x;
  }
  for (Eigen::Index j = 0; j < dual.x.size() && !result.x; ++j)
    if (dual.x[j] > 0)
      result.excluding.push_back(j);
  return result;
}

/// A motion in the span of `open` that all contacts leave some room for, or nothing if they leave none: then those that
/// exclude it hold the motions across them, and the search goes on along them.
std::optional<Eigen::VectorXd> looseMotion(const Room& room, Eigen::MatrixXd open) {
  constexpr double margin = 1e-6; // narrower than this beside the largest gap, a gap counts as closed
  while (open.cols() > 0) {
    const Eigen::MatrixXd all = open.transpose() * room.directions;
    std::vector<Eigen::Index> meeting; // contacts that the motions meet at all
    for (Eigen::Index j = 0; j < all.cols(); ++j)
      if (all.col(j).norm() > margin)
        meeting.push_back(j);
    if (meeting.empty())
      return open.col(0);
    const Eigen::MatrixXd directions = all(Eigen::all, meeting);
    const Eigen::VectorXd least =
        room.room(meeting) - Eigen::VectorXd::Constant(static_cast<Eigen::Index>(meeting.size()), margin);
    const Shortest found = shortest(directions, least);
    if (found.x)
      return open * (found.x->norm() > 0 ? *found.x : Eigen::VectorXd::Unit(open.cols(), 0));
    if (found.excluding.empty())
      return std::nullopt;
    const Eigen::MatrixXd excluding = directions(Eigen::all, found.excluding);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(excluding * excluding.transpose());
    const auto numLeft =
        (spectrum.eigenvalues().array() <= 1e-12 * spectrum.eigenvalues().maxCoeff()).count();
    open = (open * spectrum.eigenvectors().leftCols(numLeft)).eval();
  }
  return std::nullopt;
}

} // namespace

Eigen::VectorXd rigidMotion(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries,
                            const Vector& lambda, const Vector& slack, bool isSolved) {
  const Eigen::Index k = problem.kernelDimension;
  const Eigen::VectorXd lengths = modeLengths(problem);
  const Rows rows = contactRows(entries, lengths);
  const Eigen::MatrixXd normal = normalEquations(problem, rows, lambda, slack);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(normal.leftCols(k));
  const double threshold = 1e-12 * spectrum.eigenvalues().maxCoeff();
  const auto numOpen = (spectrum.eigenvalues().array() <= threshold).count();
  const Eigen::MatrixXd open = spectrum.eigenvectors().leftCols(numOpen); // what the forces leave open
  const Eigen::MatrixXd held = spectrum.eigenvectors().rightCols(k - numOpen);
  Eigen::VectorXd alpha =
      held * (held.transpose() * normal.col(k)).cwiseQuotient(spectrum.eigenvalues().tail(k - numOpen));
  const double length = slack.normInf();
  if (numOpen == 0 || length == 0)
    return alpha.cwiseQuotient(lengths);

  Room room = roomOf(problem, rows, slack, alpha);
  room.room /= length;
  if (isSolved)
    if (const auto loose = looseMotion(room, open)) {
      const Eigen::VectorXd motion = loose->cwiseQuotient(lengths);
      const std::string words = wordsOf(problem, motion);
      throw SolvabilityError(SolvabilityError::Kind::notUnique,
                             "not unique: no contact force holds " + bodiesOf(problem, motion) +
                                 ", which may come to rest anywhere between its contacts" +
                                 (words == "move" ? "" : " (free to " + words + ")") +
                                 "; add a load or a support");
    }
  if (const Shortest further = shortest(open.transpose() * room.directions, room.room); further.x)
    alpha += length * (open * *further.x);
  return alpha.cwiseQuotient(lengths);
}

} // namespace epafi::fetidp
