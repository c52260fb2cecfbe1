#include "epafi/fetidp/ContactDirections.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace epafi::fetidp {
namespace {

/// Directions are the same if they round alike: two that differ by less may still fall on both sides of a
/// boundary, and are then kept both, which costs a column and changes nothing.
constexpr double resolution = 1e-9;

} // namespace

bool isTied(const decomposition::DecomposedProblem& problem, int row) {
  return problem.kindOf(decomposition::OwnedMultiplier(row)) == decomposition::RowKind::tied;
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
  Eigen::MatrixXd all(dimension_ + 1, static_cast<Eigen::Index>(known_.size()));
  Eigen::Index column = 0;
  for (const auto& [key, row] : known_)
    all.col(column++) = row;
  return all;
}

void DistinctDirections::gather(const Comm& comm) {
  const Eigen::MatrixXd mine = all();
  const std::vector<double> gathered =
      gatherOnAll(comm, std::span(mine.data(), static_cast<std::size_t>(mine.size())));
  const Eigen::Map<const Eigen::MatrixXd> rows(gathered.data(), mine.rows(),
                                               static_cast<Eigen::Index>(gathered.size()) / mine.rows());
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

Eigen::MatrixXd contactDirections(const decomposition::DecomposedProblem& problem,
                                  const std::map<int, Eigen::VectorXd>& rows) {
  DistinctDirections directions(problem.numRigidModes());
  for (const auto& [row, vector] : rows) {
    directions.add(vector, 0.0);
    if (isTied(problem, row))
      directions.add(-vector, 0.0);
  }
  directions.gather(*problem.comm);
  return directions.matrix();
}

} // namespace epafi::fetidp
