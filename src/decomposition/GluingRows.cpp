#include "epafi/decomposition/GluingRows.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <span>

namespace epafi::decomposition {
namespace {

/// The first row of each copy's link, that to the next copy of its node; −1 where it has none: the last copies, crosspoints,
/// nodes without unknowns. Collective.
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

/// Whether a node's rows have weights: those of nodes with two copies are u_0 − u_1 = 0.
bool hasMeans(const SharedNodes& shared, std::size_t node) {
  return shared.subdomainsAt(node).size() > 2;
}

/// δ = diag K^s of all copies of nodes whose rows have weights, component by component. Collective.
std::vector<double> stiffnessOfCopies(const Substructures& all, const SharedNodes& shared,
                                      const Crosspoints& crosspoints,
                                      std::span<const std::shared_ptr<const SparseMatrix>> matrices) {
  std::vector<double> stiffness(shared.numCopies() * all.components, 0.0);
  for (std::size_t s = 0, copy = 0; s < all.size(); ++s)
    for (const SharedNodes::Copy& at : shared.copiesOf(s)) {
      if (hasMeans(shared, at.node) && !crosspoints.isCrosspoint(s, at.place))
        diagonalAt(*matrices[s], all.unknownsAt(s, at.place),
                   std::span(stiffness).subspan(copy * all.components, all.components));
      ++copy;
    }
  return shared.exchange(std::move(stiffness), all.components,
                         [&](std::size_t node) { return hasMeans(shared, node); });
}

/// Enters the rows at copies, which know those of all links at their nodes and the stiffness of all copies there.
class Entering {
public:
  Entering(const Substructures& all, const SharedNodes& shared, const std::vector<GlobalOrdinal>& links,
           const std::vector<double>& stiffness, GluingRows& result)
      : all_(all), shared_(shared), links_(links), stiffness_(stiffness), result_(result) {}

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
        result_.rows[s].push_back({row++, unknowns[c], coefficient(c)});
      }
  }

  /// δ_i / Σ δ_j over the copies up to the link's, i the copy.
  [[nodiscard]] double share(const SharedNodes::Copy& copy, std::size_t link, std::size_t component) const {
    const auto at = [&](std::size_t order) {
      return stiffness_[shared_.slot(copy.node, order) * all_.components + component];
    };
    double sum = 0;
    for (std::size_t order = 0; order <= link; ++order)
      sum += at(order);
    return at(copy.order) / sum;
  }

  const Substructures& all_;
  const SharedNodes& shared_;
  const std::vector<GlobalOrdinal>& links_;
  const std::vector<double>& stiffness_;
  GluingRows& result_;
};

} // namespace

GluingRows gluingRows(const Substructures& all, const SharedNodes& shared, const Crosspoints& crosspoints,
                      std::span<const std::shared_ptr<const SparseMatrix>> stiffness,
                      GlobalOrdinal firstRow) {
  GluingRows result;
  const std::vector<GlobalOrdinal> links = shared.exchange(
      numberLinks(all, shared, crosspoints, firstRow, result.numRows), 1, [](std::size_t) { return true; });
  const std::vector<double> weights = stiffnessOfCopies(all, shared, crosspoints, stiffness);
  Entering entering(all, shared, links, weights, result);
  for (std::size_t s = 0; s < all.size(); ++s) {
    result.rows.emplace_back().reserve(2 * shared.copiesOf(s).size());
    for (const SharedNodes::Copy& copy : shared.copiesOf(s))
      entering.enterAt(s, copy);
  }
  return result;
}

} // namespace epafi::decomposition
