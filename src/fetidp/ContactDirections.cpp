#include "epafi/fetidp/ContactDirections.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::fetidp {
namespace {

/// Directions are the same if they round alike: two that differ by less may still fall on both sides of a
/// boundary, and are then kept both, which costs a column and changes nothing.
constexpr double resolution = 1e-9;

} // namespace

Eigen::VectorXd modeLengths(const decomposition::DecomposedProblem& problem) {
  Eigen::VectorXd lengths = Eigen::VectorXd::Zero(problem.kernelDimension);
  for (const auto& subdomain : problem.subdomains) {
    const auto offset = problem.bodies[static_cast<std::size_t>(subdomain.body)].kernelOffset;
    for (Eigen::Index mode = 0; mode < subdomain.kernel.cols() && subdomain.kernel.rows() > 0; ++mode)
      lengths[offset + mode] =
          std::max(lengths[offset + mode], subdomain.kernel.col(mode).lpNorm<Eigen::Infinity>());
  }
  for (double& length : lengths) {
    length = maxOverRanks(*problem.comm, length);
    length = length > 0 ? length : 1.0;
  }
  return lengths;
}

void DistinctDirections::add(const Eigen::VectorXd& direction, double value) {
  const double norm = direction.norm();
  if (!(norm > 0))
    return;
  std::vector<long long> key;
  key.reserve(static_cast<std::size_t>(dimension_));
  for (const double entry : direction)
    key.push_back(std::llround(entry / norm / resolution));
  const auto [place, isNew] = places_.try_emplace(std::move(key), values_.size());
  if (isNew) {
    directions_.emplace_back(direction / norm);
    values_.push_back(value / norm);
  } else {
    values_[place->second] = std::min(values_[place->second], value / norm);
  }
}

void DistinctDirections::gather(const Comm& comm) {
  std::vector<double> mine;
  mine.reserve(values_.size() * static_cast<std::size_t>(dimension_ + 1));
  for (std::size_t j = 0; j < values_.size(); ++j) {
    mine.insert(mine.end(), directions_[j].begin(), directions_[j].end());
    mine.push_back(values_[j]);
  }
  const std::vector<double> all = gatherOnAll(comm, mine);
  places_.clear();
  directions_.clear();
  values_.clear();
  const auto stride = static_cast<std::size_t>(dimension_ + 1);
  for (std::size_t first = 0; first < all.size(); first += stride)
    add(Eigen::Map<const Eigen::VectorXd>(all.data() + first, dimension_), all[first + stride - 1]);
}

Eigen::MatrixXd DistinctDirections::matrix() const {
  Eigen::MatrixXd result(dimension_, size());
  for (std::size_t j = 0; j < directions_.size(); ++j)
    result.col(static_cast<Eigen::Index>(j)) = directions_[j];
  return result;
}

Eigen::VectorXd DistinctDirections::values() const {
  return Eigen::Map<const Eigen::VectorXd>(values_.data(), size());
}

std::map<int, Eigen::VectorXd> contactRows(const std::vector<KernelEntry>& entries,
                                           const Eigen::VectorXd& lengths) {
  std::map<int, Eigen::VectorXd> rows;
  for (const KernelEntry& entry : entries)
    rows.try_emplace(entry.row, Eigen::VectorXd::Zero(lengths.size())).first->second[entry.mode] +=
        entry.value / lengths[entry.mode];
  return rows;
}

Eigen::MatrixXd contactDirections(const decomposition::DecomposedProblem& problem,
                                  const std::vector<KernelEntry>& entries, const Eigen::VectorXd& lengths) {
  DistinctDirections directions(problem.kernelDimension);
  for (const auto& [row, vector] : contactRows(entries, lengths))
    directions.add(vector, 0.0);
  directions.gather(*problem.comm);
  return directions.matrix();
}

} // namespace epafi::fetidp
