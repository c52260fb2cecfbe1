#include "epafi/fetidp/KernelGram.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/qp/LocalData.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <span>

namespace epafi::fetidp {
namespace {

using Pairs = std::vector<std::int64_t>;

/// Entries of one row after the other.
template <class Body>
void forEachRow(const std::vector<KernelEntry>& entries, const Body& body) {
  for (auto first = entries.begin(), end = first; first != entries.end(); first = end) {
    while (end != entries.end() && end->row == first->row)
      ++end;
    body(std::span(first, end));
  }
}

/// Two entries of a row, and the place of what they add to in the lower triangle.
template <class Body>
void forEachPair(std::span<const KernelEntry> row, int size, const Body& body) {
  for (const KernelEntry& a : row)
    for (const KernelEntry& b : row)
      if (a.mode >= b.mode)
        body(static_cast<std::int64_t>(b.mode) * size + a.mode, a.value * b.value);
}

template <class Values>
void sortOnce(Values& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

std::size_t placeIn(const Pairs& pairs, std::int64_t pair) {
  return static_cast<std::size_t>(std::lower_bound(pairs.begin(), pairs.end(), pair) - pairs.begin());
}

/// All pairs of the rows, of all ranks. Collective.
Pairs pairsOf(const Comm& comm, const std::vector<KernelEntry>& entries, int size) {
  Pairs pairs;
  std::span<const KernelEntry> last; // neighbours in a face join the same modes
  const auto haveSameMode = [](const KernelEntry& a, const KernelEntry& b) { return a.mode == b.mode; };
  forEachRow(entries, [&](std::span<const KernelEntry> row) {
    if (!std::equal(row.begin(), row.end(), last.begin(), last.end(), haveSameMode))
      forEachPair(row, size, [&](std::int64_t pair, double) { pairs.push_back(pair); });
    last = row;
  });
  sortOnce(pairs);
  pairs = gatherOnAll(comm, pairs);
  sortOnce(pairs);
  return pairs;
}

/// See ContactGram. Not collective.
std::vector<int> anchorsAmong(const std::vector<int>& modes,
                              const decomposition::DecomposedProblem& problem) {
  std::vector<std::vector<int>> found(problem.bodies.size());               // of each body
  std::vector<std::vector<Eigen::VectorXd>> motions(problem.bodies.size()); // of the body there
  for (const decomposition::Cluster& cluster : problem.clusters)
    for (int mode = 0; mode < cluster.kernelDimension; ++mode) {
      const auto place = std::lower_bound(modes.begin(), modes.end(), cluster.kernelOffset + mode);
      if (place == modes.end() || *place != cluster.kernelOffset + mode)
        continue;
      const auto body = static_cast<std::size_t>(cluster.body);
      found[body].push_back(static_cast<int>(place - modes.begin()));
      motions[body].emplace_back(cluster.ofBody.row(mode).transpose());
    }
  std::vector<int> anchors;
  for (std::size_t body = 0; body < found.size(); ++body) {
    const Eigen::Index dimension = found[body].empty() ? 0 : motions[body].front().size();
    if (dimension == 0)
      continue;
    Eigen::MatrixXd columns(dimension, static_cast<Eigen::Index>(found[body].size()));
    for (std::size_t i = 0; i < found[body].size(); ++i)
      columns.col(static_cast<Eigen::Index>(i)) = motions[body][i];
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    for (Eigen::Index i = 0; i < qr.rank(); ++i)
      anchors.push_back(found[body][static_cast<std::size_t>(qr.colsPermutation().indices()[i])]);
  }
  return anchors;
}

} // namespace

Eigen::SparseMatrix<double> kernelGram(const decomposition::DecomposedProblem& problem,
                                       const std::vector<KernelEntry>& entries) {
  const int size = problem.kernelDimension;
  const Pairs pairs = pairsOf(*problem.comm, entries, size);
  std::vector<AccurateSum> sums(pairs.size());
  forEachRow(entries, [&](std::span<const KernelEntry> row) {
    forEachPair(row, size, [&](std::int64_t pair, double value) { sums[placeIn(pairs, pair)].add(value); });
  });
  sumOverRanks(*problem.comm, sums);
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i)
    triplets.emplace_back(static_cast<int>(pairs[i] % size), static_cast<int>(pairs[i] / size),
                          sums[i].value());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

ContactGram::ContactGram(const decomposition::DecomposedProblem& problem,
                         const std::vector<KernelEntry>& entries)
    : comm_(problem.comm) {
  std::vector<KernelEntry> contact;
  for (const KernelEntry& entry : entries)
    if (problem.kindOf(decomposition::OwnedMultiplier(entry.row)) == decomposition::RowKind::contact) {
      contact.push_back(entry);
      modes_.push_back(entry.mode);
    }
  sortOnce(modes_);
  modes_ = gatherOnAll(*comm_, modes_);
  sortOnce(modes_);
  anchors_ = anchorsAmong(modes_, problem);
  for (KernelEntry& entry : contact)
    entry.mode =
        static_cast<int>(std::lower_bound(modes_.begin(), modes_.end(), entry.mode) - modes_.begin());
  const int size = static_cast<int>(modes_.size());
  pairs_ = pairsOf(*comm_, contact, size);
  forEachRow(contact, [&](std::span<const KernelEntry> row) {
    forEachPair(row, size, [&](std::int64_t pair, double value) {
      terms_.push_back({placeIn(pairs_, pair), row.front().row, value});
    });
  });
}

Eigen::MatrixXd ContactGram::offFace(const Vector& face) const {
  const auto isFree = qp::localData(face);
  std::vector<AccurateSum> sums(pairs_.size());
  for (const Term& term : terms_)
    if (isFree[static_cast<std::size_t>(term.row)] == 0)
      sums[term.pair].add(term.value);
  sumOverRanks(*comm_, sums);
  const auto n = static_cast<Eigen::Index>(modes_.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    matrix(pairs_[i] % n, pairs_[i] / n) = sums[i].value();
    matrix(pairs_[i] / n, pairs_[i] % n) = sums[i].value();
  }
  return matrix;
}

} // namespace epafi::fetidp
