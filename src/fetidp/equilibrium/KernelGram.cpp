#include "epafi/fetidp/equilibrium/KernelGram.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

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
        body(std::int64_t{b.mode} * size + a.mode, a.value * b.value);
}

std::size_t placeIn(const Pairs& pairs, std::int64_t pair) {
  return std::lower_bound(pairs.begin(), pairs.end(), pair) - pairs.begin();
}

/// The pairs of this rank's rows, ascending. Not collective.
Pairs pairsOf(const std::vector<KernelEntry>& entries, int size) {
  Pairs pairs;
  std::span<const KernelEntry> last; // neighbours in a face join the same modes
  const auto haveSameMode = [](const KernelEntry& a, const KernelEntry& b) { return a.mode == b.mode; };
  forEachRow(entries, [&](std::span<const KernelEntry> row) {
    if (!std::equal(row.begin(), row.end(), last.begin(), last.end(), haveSameMode))
      forEachPair(row, size, [&](std::int64_t pair, double) { pairs.push_back(pair); });
    last = row;
  });
  sortUnique(pairs);
  return pairs;
}

/// What rows add to an entry.
struct GramTerm {
  std::int64_t pair;
  AccurateSum sum;
};
using GramTerms = std::vector<GramTerm>;

/// This rank's, ascending by pairs. Not collective.
GramTerms termsOf(const std::vector<KernelEntry>& entries, int size) {
  const Pairs pairs = pairsOf(entries, size);
  GramTerms terms;
  for (const std::int64_t pair : pairs)
    terms.push_back({pair, {}});
  forEachRow(entries, [&](std::span<const KernelEntry> row) {
    forEachPair(row, size,
                [&](std::int64_t pair, double value) { terms[placeIn(pairs, pair)].sum.add(value); });
  });
  return terms;
}

/// Those of several ranks, one for each pair.
GramTerms merged(GramTerms terms) {
  std::stable_sort(terms.begin(), terms.end(),
                   [](const GramTerm& a, const GramTerm& b) { return a.pair < b.pair; });
  std::size_t size = 0;
  for (const GramTerm& term : terms)
    if (size > 0 && terms[size - 1].pair == term.pair)
      terms[size - 1].sum.add(term.sum);
    else
      terms[size++] = term;
  terms.resize(size);
  return terms;
}

/// Whether a multiplier (local index in multiplierMap) may be off a face.
bool mayLeave(const decomposition::DecomposedProblem& problem, int row) {
  const decomposition::RowKind kind = problem.kindOf(decomposition::OwnedMultiplier(row));
  return kind == decomposition::RowKind::contact || kind == decomposition::RowKind::friction;
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
      const std::size_t body = cluster.body;
      found[body].push_back(static_cast<int>(place - modes.begin()));
      motions[body].emplace_back(cluster.ofBody.row(mode).transpose());
    }
  std::vector<int> anchors;
  for (std::size_t body = 0; body < found.size(); ++body) {
    const Eigen::Index dimension = found[body].empty() ? 0 : motions[body].front().size();
    if (dimension == 0)
      continue;
    Eigen::MatrixXd columns(dimension, found[body].size());
    for (std::size_t i = 0; i < found[body].size(); ++i)
      columns.col(i) = motions[body][i];
    const direct::PivotedColumns pivoted = direct::pivotedColumns(columns);
    for (Eigen::Index i = 0; i < pivoted.rank; ++i)
      anchors.push_back(found[body][pivoted.order[i]]);
  }
  return anchors;
}

} // namespace

Eigen::SparseMatrix<double> kernelGram(const decomposition::DecomposedProblem& problem,
                                       const std::vector<KernelEntry>& entries, const RankGroups& groups) {
  const int size = problem.kernelDimension;
  Eigen::SparseMatrix<double> matrix(size, size);
  GramTerms terms = gatherOnFirst(*groups.group(), termsOf(entries, size));
  if (!groups.leads())
    return matrix;
  terms = merged(gatherOnAll(*groups.leaders(), merged(std::move(terms))));
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(terms.size());
  for (const GramTerm& term : terms)
    triplets.emplace_back(static_cast<int>(term.pair % size), static_cast<int>(term.pair / size),
                          term.sum.value());
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

ContactGram::ContactGram(const decomposition::DecomposedProblem& problem,
                         const std::vector<KernelEntry>& entries)
    : comm_(problem.comm) {
  std::vector<KernelEntry> contact;
  for (const KernelEntry& entry : entries)
    if (mayLeave(problem, entry.row)) {
      contact.push_back(entry);
      modes_.push_back(entry.mode);
    }
  sortUnique(modes_);
  modes_ = gatherOnAll(*comm_, modes_);
  sortUnique(modes_);
  anchors_ = anchorsAmong(modes_, problem);
  for (KernelEntry& entry : contact)
    entry.mode =
        static_cast<int>(std::lower_bound(modes_.begin(), modes_.end(), entry.mode) - modes_.begin());
  const int size = static_cast<int>(modes_.size());
  std::map<int, std::span<const KernelEntry>> rows;
  forEachRow(contact, [&](std::span<const KernelEntry> row) { rows.emplace(row.front().row, row); });
  const auto forEachMixed = [&](const auto& body) {
    for (const decomposition::FrictionNode& node : problem.frictionNodes)
      if (const auto first = rows.find(node.firstTangent), second = rows.find(node.firstTangent + 1);
          problem.components > 2 && first != rows.end() && second != rows.end())
        for (const KernelEntry& a : first->second)
          for (const KernelEntry& b : second->second)
            body(std::int64_t{std::min(a.mode, b.mode)} * size + std::max(a.mode, b.mode), first->first,
                 (a.mode == b.mode ? 2 : 1) * a.value * b.value);
  };
  Pairs pairs = pairsOf(contact, size);
  forEachMixed([&](std::int64_t pair, int /*row*/, double /*value*/) { pairs.push_back(pair); });
  sortUnique(pairs);
  pairs_ = gatherOnAll(*comm_, pairs);
  sortUnique(pairs_);
  forEachMixed([&](std::int64_t pair, int row, double value) {
    mixed_.push_back({placeIn(pairs_, pair), row, value});
  });
  forEachRow(contact, [&](std::span<const KernelEntry> row) {
    forEachPair(row, size, [&](std::int64_t pair, double value) {
      terms_.push_back({placeIn(pairs_, pair), row.front().row, value});
    });
  });
}

Eigen::MatrixXd ContactGram::offFace(const qp::Face& face) const {
  const auto isFree = qp::localData(face.isFree);
  std::vector<double> off(isFree.size()), mixed(face.tangents.empty() ? 0 : isFree.size(), 0.0);
  for (std::size_t row = 0; row < off.size(); ++row)
    off[row] = isFree[row] == 0 ? 1 : 0;
  for (const qp::CircleTangent& tangent : face.tangents) { // nnᵀ, n = (t₂, −t₁)
    const auto [t1, t2] = tangent.along;
    off[tangent.first] = t2 * t2;
    off[tangent.second] = t1 * t1;
    mixed[tangent.first] = -t1 * t2;
  }
  std::vector<AccurateSum> sums(pairs_.size());
  for (const Term& term : terms_)
    if (off[term.row] != 0)
      sums[term.pair].add(off[term.row] * term.value);
  if (!mixed.empty())
    for (const Term& term : mixed_)
      sums[term.pair].add(mixed[term.row] * term.value);
  sumOverRanks(*comm_, sums);
  const Eigen::Index n = modes_.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    matrix(pairs_[i] % n, pairs_[i] / n) = sums[i].value();
    matrix(pairs_[i] / n, pairs_[i] % n) = sums[i].value();
  }
  return matrix;
}

} // namespace epafi::fetidp
