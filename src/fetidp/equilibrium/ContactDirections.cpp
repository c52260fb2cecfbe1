#include "epafi/fetidp/equilibrium/ContactDirections.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>

namespace epafi::fetidp {
namespace {

/// Directions are the same if they round alike: two that differ by less may still fall on both sides of a
/// boundary, and are then kept both, which costs a column and changes nothing.
constexpr double resolution = 1e-9;

} // namespace

bool isTied(const decomposition::DecomposedProblem& problem, int row) {
  return problem.kindOf(decomposition::OwnedMultiplier(row)) != decomposition::RowKind::contact;
}

void DistinctDirections::add(const Eigen::VectorXd& direction, double value) {
  const double norm = direction.norm();
  if (!(norm > 0))
    return;
  std::vector<long long> key;
  for (const double entry : direction)
    key.push_back(std::llround(entry / norm / resolution));
  const auto [known, isNew] = known_.try_emplace(std::move(key), dimension_ + 1);
  Eigen::VectorXd& row = known->second;
  if (isNew)
    row << direction / norm, value / norm;
  row[dimension_] = std::min(row[dimension_], value / norm);
}

Eigen::MatrixXd DistinctDirections::all() const {
  Eigen::MatrixXd all(dimension_ + 1, known_.size());
  Eigen::Index column = 0;
  for (const auto& [key, row] : known_)
    all.col(column++) = row;
  return all;
}

void DistinctDirections::gather(const Comm& comm) {
  const Eigen::MatrixXd mine = all();
  const std::vector<double> gathered = gatherOnAll(comm, std::span(mine.data(), mine.size()));
  const Eigen::Map<const Eigen::MatrixXd> rows(gathered.data(), mine.rows(),
                                               std::ssize(gathered) / mine.rows());
  known_.clear();
  for (Eigen::Index j = 0; j < rows.cols(); ++j)
    add(rows.col(j).head(dimension_), rows(dimension_, j));
}

Eigen::MatrixXd DistinctDirections::matrix() const {
  return all().topRows(dimension_);
}

Eigen::VectorXd DistinctDirections::values() const {
  return all().row(dimension_);
}

namespace {

/// Adds the edges of a node's cone of Coulomb's friction. \param slope  μ
void addCone(const decomposition::DecomposedProblem& problem, const decomposition::FrictionNode& node,
             double slope, const std::map<int, Eigen::VectorXd>& rows, DistinctDirections& directions) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(problem.numRigidModes());
  const auto rowOf = [&](int row) {
    const auto found = rows.find(row);
    return found == rows.end() ? none : found->second;
  };
  const int numEdges = problem.components > 2 ? 16 : 2;
  const double around = problem.components > 2 ? 1 / std::cos(std::numbers::pi / numEdges) : 1;
  for (int edge = 0; edge < numEdges; ++edge) {
    const double angle = 2 * std::numbers::pi * edge / numEdges;
    Eigen::VectorXd direction =
        rowOf(node.contact) + slope * around * std::cos(angle) * rowOf(node.firstTangent);
    if (problem.components > 2)
      direction += slope * around * std::sin(angle) * rowOf(node.firstTangent + 1);
    directions.add(direction, 0.0);
  }
}

} // namespace

Eigen::MatrixXd contactDirections(const decomposition::DecomposedProblem& problem,
                                  const decomposition::ProblemData& data,
                                  const std::map<int, Eigen::VectorXd>& rows) {
  DistinctDirections directions(problem.numRigidModes());
  std::set<int> inCones; // what no force holds whatever presses there
  for (const decomposition::FrictionNode& node : problem.frictionNodes)
    if (data.frictionBound(node, 0) == 0) {
      for (int k = 0; k < problem.components - 1; ++k)
        inCones.insert(node.firstTangent + k);
      if (const double slope = data.frictionBound(node, 1); slope > 0)
        addCone(problem, node, slope, rows, directions);
    }
  for (const auto& [row, vector] : rows) {
    if (inCones.contains(row))
      continue;
    directions.add(vector, 0.0);
    if (isTied(problem, row))
      directions.add(-vector, 0.0);
  }
  directions.gather(*problem.comm);
  return directions.matrix();
}

} // namespace epafi::fetidp
