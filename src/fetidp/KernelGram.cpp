#include "epafi/fetidp/KernelGram.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/qp/LocalData.hpp"

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

void sortOnce(Pairs& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
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

} // namespace

KernelGram::KernelGram(const decomposition::DecomposedProblem& problem,
                       const std::vector<KernelEntry>& entries)
    : comm_(problem.comm), size_(problem.kernelDimension) {
  std::vector<KernelEntry> fixed, contact;
  for (const KernelEntry& entry : entries)
    (problem.kindOf(decomposition::OwnedMultiplier(entry.row)) == decomposition::RowKind::contact ? contact
                                                                                                  : fixed)
        .push_back(entry);
  fixed_ = pairsOf(*comm_, fixed, size_);
  contact_ = pairsOf(*comm_, contact, size_);
  ofFixed_.assign(fixed_.size(), AccurateSum());
  forEachRow(fixed, [&](std::span<const KernelEntry> row) {
    forEachPair(row, size_,
                [&](std::int64_t pair, double value) { ofFixed_[placeIn(fixed_, pair)].add(value); });
  });
  sumOverRanks(*comm_, ofFixed_);
  forEachRow(contact, [&](std::span<const KernelEntry> row) {
    forEachPair(row, size_, [&](std::int64_t pair, double value) {
      terms_.push_back({placeIn(contact_, pair), row.front().row, value});
    });
  });
  for (const std::int64_t pair : contact_)
    if (pair % size_ == pair / size_) // a row that joins two modes has a term with each alone
      contactModes_.push_back(static_cast<int>(pair / size_));
}

/// Of all ranks, over the rows of contact that count. Collective.
template <class Counts>
std::vector<AccurateSum> KernelGram::sumsOf(const Counts& counts) const {
  std::vector<AccurateSum> sums(contact_.size());
  for (const Term& term : terms_)
    if (counts(term.row))
      sums[term.pair].add(term.value);
  sumOverRanks(*comm_, sums);
  return sums;
}

KernelGram::Matrix KernelGram::whole() const {
  const std::vector<AccurateSum> contact = sumsOf([](int) { return true; });
  using Triplet = Eigen::Triplet<double>;
  std::vector<Triplet> triplets;
  triplets.reserve(fixed_.size() + contact_.size());
  const auto add = [&](const Pairs& pairs, const std::vector<AccurateSum>& sums) {
    for (std::size_t i = 0; i < pairs.size(); ++i)
      triplets.emplace_back(static_cast<int>(pairs[i] % size_), static_cast<int>(pairs[i] / size_),
                            sums[i].value());
  };
  add(fixed_, ofFixed_);
  add(contact_, contact);
  Matrix matrix(size_, size_);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

Eigen::MatrixXd KernelGram::offFace(const Vector& face) const {
  const auto isFree = qp::localData(face);
  const std::vector<AccurateSum> sums =
      sumsOf([&](int row) { return isFree[static_cast<std::size_t>(row)] == 0; });
  const auto placeOf = [this](std::int64_t mode) {
    return std::lower_bound(contactModes_.begin(), contactModes_.end(), mode) - contactModes_.begin();
  };
  const auto n = static_cast<Eigen::Index>(contactModes_.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < contact_.size(); ++i) {
    const auto row = placeOf(contact_[i] % size_), column = placeOf(contact_[i] / size_);
    matrix(row, column) = sums[i].value();
    matrix(column, row) = sums[i].value();
  }
  return matrix;
}

} // namespace epafi::fetidp
