#include "epafi/decomposition/GluingRows.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace epafi::decomposition {
namespace {

/// The first row of each copy's link, that to the next copy of its node; −1 where it has none: the last
/// copies, crosspoints, nodes without unknowns. Collective.
std::vector<GlobalOrdinal> numberLinks(const Substructures& all, const SharedNodes& shared,
                                       const Crosspoints& crosspoints, GlobalOrdinal firstRow,
                                       GlobalOrdinal& numRows) {
  std::vector<GlobalOrdinal> rows(shared.numCopies(), -1);
  GlobalOrdinal number = 0;
  for (std::size_t s = 0, copy = 0; s < all.size(); ++s)
    for (const SharedNodes::Copy& at : shared.copiesOf(s)) {
      if (const int numFree = all.numFree(s, at.place); numFree > 0 &&
                                                        !crosspoints.isCrosspoint(s, at.place) &&
                                                        at.order + 1 < shared.subdomainsAt(at.node).size()) {
        rows[copy] = number;
        number += numFree;
      }
      ++copy;
    }
  const GlobalOrdinal before = sumBefore(*all.comm, number); // ranks have their subdomains in ascending order
  for (GlobalOrdinal& row : rows)
    if (row >= 0)
      row += firstRow + before;
  numRows = sumOverRanks(*all.comm, number);
  return rows;
}

/// Whether a node's rows have weights, shares of copies in means: those of nodes with two copies are u_0 −
/// u_1 = 0.
bool hasMeans(const SharedNodes& shared, std::size_t node) {
  return shared.subdomainsAt(node).size() > 2;
}

/// Of each shared node: whether its subdomains are of several clusters.
std::vector<bool> nodesBetweenClusters(const SharedNodes& shared, std::span<const int> clusterOf) {
  std::vector<bool> between(shared.numNodes());
  for (std::size_t node = 0; node < between.size(); ++node) {
    const std::span<const int> at = shared.subdomainsAt(node);
    between[node] = std::any_of(at.begin(), at.end(),
                                [&](int number) { return clusterOf[number] != clusterOf[at.front()]; });
  }
  return between;
}

/// δ = diag K^s of all copies at nodes whose rows have weights or sizes, component by component.
class NodalStiffness {
public:
  /// Collective.
  NodalStiffness(const Substructures& all, const SharedNodes& shared, const Crosspoints& crosspoints,
                 const std::vector<bool>& isBetween,
                 std::span<const std::shared_ptr<const SparseMatrix>> matrices)
      : shared_(shared), components_(all.components), values_(shared.numCopies() * all.components, 0.0) {
    const auto isWanted = [&](std::size_t node) { return hasMeans(shared, node) || isBetween[node]; };
    for (std::size_t s = 0, copy = 0; s < all.size(); ++s)
      for (const SharedNodes::Copy& at : shared.copiesOf(s)) {
        if (isWanted(at.node) && !crosspoints.isCrosspoint(s, at.place))
          diagonalAt(*matrices[s], all.unknownsAt(s, at.place),
                     std::span(values_).subspan(copy * components_, components_));
        ++copy;
      }
    values_ = shared.exchange(std::move(values_), components_, isWanted);
  }

  [[nodiscard]] double at(std::size_t node, std::size_t order, std::size_t component) const {
    return values_[shared_.slot(node, order) * components_ + component];
  }
  /// Σ δ_j over the copies up to a link's first.
  [[nodiscard]] double upTo(std::size_t node, std::size_t link, std::size_t component) const {
    double sum = 0;
    for (std::size_t order = 0; order <= link; ++order)
      sum += at(node, order, component);
    return sum;
  }
  /// (b D⁻¹bᵀ)⁻¹ of a link's row b.
  [[nodiscard]] double ofRow(std::size_t node, std::size_t link, std::size_t component) const {
    return 1 / (1 / upTo(node, link, component) + 1 / at(node, link + 1, component));
  }

private:
  const SharedNodes& shared_;
  std::size_t components_;
  std::vector<double> values_;
};

/// Enters the rows at copies, which know those of all links at their nodes and the stiffness of all copies
/// there.
class Entering {
public:
  /// Collective.
  Entering(const Substructures& all, const SharedNodes& shared, const std::vector<GlobalOrdinal>& links,
           const std::vector<bool>& isBetween, const NodalStiffness& stiffness, GluingRows& result)
      : all_(all), shared_(shared), links_(links), isBetween_(isBetween), stiffness_(stiffness),
        result_(result), mean_(meanOfRows()) {}

  void enterAt(std::size_t s, const SharedNodes::Copy& copy) {
    const std::size_t numLinks = shared_.subdomainsAt(copy.node).size() - 1;
    if (copy.order > 0)
      enter(s, copy, copy.order - 1, [](std::size_t) { return -1.0; });
    if (!hasMeans(shared_, copy.node) && copy.order == 0)
      enter(s, copy, 0, [](std::size_t) { return 1.0; });
    for (std::size_t link = copy.order; hasMeans(shared_, copy.node) && link < numLinks; ++link)
      enter(s, copy, link, [&](std::size_t component) { return share(copy, link, component); });
  }

private:
  template <class Coefficient>
  void enter(std::size_t s, const SharedNodes::Copy& copy, std::size_t link, Coefficient&& coefficient) {
    const std::size_t slot = shared_.slot(copy.node, link);
    GlobalOrdinal row = links_[slot];
    const std::span<const int> unknowns = all_.unknownsAt(s, copy.place);
    for (std::size_t c = 0; c < unknowns.size(); ++c)
      if (row >= 0 && unknowns[c] >= 0) {
        if (slot >= shared_.numCopies())
          result_.elsewhere.push_back(row);
        else if (link == copy.order)
          result_.owned.push_back(row);
        result_.rows[s].push_back({row++, unknowns[c], size(copy.node, link, c) * coefficient(c)});
      }
  }

  /// δ_i / Σ δ_j over the copies up to the link's, i the copy.
  [[nodiscard]] double share(const SharedNodes::Copy& copy, std::size_t link, std::size_t component) const {
    return stiffness_.at(copy.node, copy.order, component) / stiffness_.upTo(copy.node, link, component);
  }

  /// Whether a row is one between clusters, of things with stiffness: what has none is for the factorisations
  /// to refuse.
  [[nodiscard]] bool hasSize(std::size_t node, std::size_t link, std::size_t component) const {
    const double stiffness = isBetween_[node] ? stiffness_.ofRow(node, link, component) : 0.0;
    return stiffness > 0 && std::isfinite(stiffness);
  }
  /// What it is multiplied by; 1 for other rows. Beyond 10^±3 digits of P are lost.
  [[nodiscard]] double size(std::size_t node, std::size_t link, std::size_t component) const {
    return hasSize(node, link, component)
               ? std::sqrt(std::clamp(stiffness_.ofRow(node, link, component) / mean_, 1e-6, 1e6))
               : 1.0;
  }

  /// Of the stiffness of all rows between clusters the geometric mean, the same on any number of ranks.
  /// Collective.
  [[nodiscard]] double meanOfRows() const {
    std::array<AccurateSum, 2> sums; // of logarithms, and their number
    for (std::size_t s = 0; s < all_.size(); ++s)
      for (const SharedNodes::Copy& copy : shared_.copiesOf(s)) {
        const std::size_t slot = shared_.slot(copy.node, copy.order);
        const std::span<const int> unknowns = all_.unknownsAt(s, copy.place);
        for (std::size_t c = 0; c < unknowns.size(); ++c)
          if (links_[slot] >= 0 && unknowns[c] >= 0 && hasSize(copy.node, copy.order, c)) {
            sums[0].add(std::log(stiffness_.ofRow(copy.node, copy.order, c)));
            sums[1].add(1.0);
          }
      }
    sumOverRanks(*all_.comm, sums);
    return sums[1].value() > 0 ? std::exp(sums[0].value() / sums[1].value()) : 1.0;
  }

  const Substructures& all_;
  const SharedNodes& shared_;
  const std::vector<GlobalOrdinal>& links_;
  const std::vector<bool>& isBetween_;
  const NodalStiffness& stiffness_;
  GluingRows& result_;
  double mean_;
};

} // namespace

GluingRows gluingRows(const Substructures& all, const SharedNodes& shared, const Crosspoints& crosspoints,
                      std::span<const int> clusterOf,
                      std::span<const std::shared_ptr<const SparseMatrix>> stiffness,
                      GlobalOrdinal firstRow) {
  GluingRows result;
  const std::vector<GlobalOrdinal> links = shared.exchange(
      numberLinks(all, shared, crosspoints, firstRow, result.numRows), 1, [](std::size_t) { return true; });
  const std::vector<bool> isBetween = nodesBetweenClusters(shared, clusterOf);
  const NodalStiffness nodal(all, shared, crosspoints, isBetween, stiffness);
  Entering entering(all, shared, links, isBetween, nodal, result);
  for (std::size_t s = 0; s < all.size(); ++s) {
    result.rows.emplace_back().reserve(2 * shared.copiesOf(s).size());
    for (const SharedNodes::Copy& copy : shared.copiesOf(s))
      entering.enterAt(s, copy);
  }
  return result;
}

} // namespace epafi::decomposition
