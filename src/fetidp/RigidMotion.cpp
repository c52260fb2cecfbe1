#include "epafi/fetidp/RigidMotion.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/NonNegativeLeastSquares.hpp"
#include "epafi/fetidp/Solvability.hpp"

#include <Eigen/Eigenvalues>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <map>
#include <optional>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using Rows = std::map<int, Eigen::VectorXd>;

/// This rank's rows of G̃ᵀ.
Rows rowsOf(const std::vector<KernelEntry>& entries, Eigen::Index numModes) {
  Rows rows;
  for (const KernelEntry& entry : entries)
    rows.try_emplace(entry.row, Eigen::VectorXd::Zero(numModes)).first->second[entry.mode] += entry.value;
  return rows;
}

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

/// What the contacts allow: directionsᵀα ≤ room, one column a distinct direction.
struct Room {
  Eigen::MatrixXd directions; ///< k × (a few)
  Eigen::VectorXd room;
};

/// Adds a row, or tightens the one of the same direction.
void addRow(std::vector<Eigen::VectorXd>& rows, const Eigen::VectorXd& row) {
  const Eigen::Index k = row.size() - 1;
  const auto same = std::find_if(rows.begin(), rows.end(), [&](const Eigen::VectorXd& other) {
    return (other - row).head(k).norm() < 1e-12;
  });
  if (same == rows.end())
    rows.push_back(row);
  else
    (*same)[k] = std::min((*same)[k], row[k]);
}

/// Collective.
Room roomOf(const DecomposedProblem& problem, const Rows& rows, const Vector& slack,
            const Eigen::VectorXd& alpha) {
  const Eigen::Index k = problem.kernelDimension;
  const auto gap = slack.getData();
  std::vector<Eigen::VectorXd> distinct; // direction and room
  for (const auto& [row, vector] : rows) {
    Eigen::VectorXd entry(k + 1);
    entry << vector, gap[row] - vector.dot(alpha);
    addRow(distinct, entry / vector.norm());
  }
  std::vector<double> mine;
  for (const Eigen::VectorXd& entry : distinct)
    mine.insert(mine.end(), entry.begin(), entry.end());
  const std::vector<double> all = gatherOnAll(*problem.comm, mine);
  distinct.clear();
  for (std::size_t first = 0; first < all.size(); first += static_cast<std::size_t>(k) + 1)
    addRow(distinct, Eigen::Map<const Eigen::VectorXd>(all.data() + first, k + 1));
  Room room{Eigen::MatrixXd(k, distinct.size()), Eigen::VectorXd(distinct.size())};
  for (std::size_t j = 0; j < distinct.size(); ++j) {
    room.directions.col(static_cast<Eigen::Index>(j)) = distinct[j].head(k);
    room.room[static_cast<Eigen::Index>(j)] = distinct[j][k];
  }
  return room;
}

/// Shortest x with Cᵀx ≤ s (to 1e-9), or nothing if there is none (Lawson, Hanson, *Solving Least Squares Problems*,
/// 1974, ch. 23.4: least distance programming).
std::optional<Eigen::VectorXd> shortest(const Eigen::MatrixXd& c, const Eigen::VectorXd& s) {
  const Eigen::Index n = c.rows();
  Eigen::MatrixXd e(n + 1, c.cols());
  e << -c, -s.transpose();
  const Eigen::VectorXd residual = nonNegativeLeastSquares(e, Eigen::VectorXd::Unit(n + 1, n)).residual;
  if (residual[n] <= 0)
    return std::nullopt;
  const Eigen::VectorXd x = -residual.head(n) / residual[n]; // round-off of a residual 0 would give anything
  if (!((c.transpose() * x - s).maxCoeff() <= 1e-9))
    return std::nullopt;
  return x;
}

} // namespace

Eigen::VectorXd rigidMotion(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries,
                            const Vector& lambda, const Vector& slack, bool isSolved) {
  const Eigen::Index k = problem.kernelDimension;
  const Rows rows = rowsOf(entries, k);
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
    return alpha;

  const Room room = roomOf(problem, rows, slack, alpha);
  const Eigen::MatrixXd directions = open.transpose() * room.directions;
  const Eigen::VectorXd relative = room.room / length;
  constexpr double margin = 1e-6; // narrower than this, a gap counts as closed
  if (isSolved && shortest(directions, relative - Eigen::VectorXd::Constant(relative.size(), margin)))
    throw SolvabilityError(
        SolvabilityError::Kind::notUnique,
        "not unique: no contact force holds " + bodiesOf(problem, open.col(0)) +
            ", which may come to rest anywhere between its contacts; add a load or a support");
  if (const auto further = shortest(directions, relative))
    alpha += length * (open * *further);
  return alpha;
}

} // namespace epafi::fetidp
