#include "epafi/decomposition/ContactRows.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/SortUnique.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_RowMatrixTransposer.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

namespace epafi::decomposition {
namespace {

void requireRows(const ConstraintMatrix& contact) {
  const Map& rows = *contact.rows->getRowMap();
  typename CrsMatrix::local_inds_host_view_type columns;
  typename CrsMatrix::values_host_view_type values;
  const GlobalOrdinal numRows = rows.getGlobalNumElements();
  for (const GlobalOrdinal number : localIndices(rows)) {
    if (number < 0 || number >= numRows)
      throw InputError("the contact matrix has " + std::to_string(numRows) + " rows, one of number " +
                       std::to_string(number) + "; rows must be numbered from 0 without holes.");
    contact.rows->getLocalRowView(rows.getLocalElement(number), columns, values);
    double largest = 0;
    for (std::size_t k = 0; k < values.extent(0); ++k) {
      if (!std::isfinite(values(k)))
        throw InputError("row " + std::to_string(number) +
                         " of the contact matrix has an entry that is not finite.");
      largest = std::max(largest, std::abs(values(k)));
    }
    if (largest == 0)
      throw InputError("row " + std::to_string(number) +
                       " of the contact matrix is empty; leave it out or give it entries.");
  }
}

/// Names a column of B_I that is no unknown. Collective.
void requireColumns(const CrsMatrix& b, const Map& unknowns) {
  const Map& columns = *b.getColMap();
  const auto wanted = localIndices(columns);
  std::vector<int> ranks(wanted.size());
  unknowns.getRemoteIndexList(wanted, Teuchos::arrayViewFromVector(ranks));
  collectively(*unknowns.getComm(), [&] {
    for (LocalOrdinal k = 0; k < wanted.size(); ++k)
      if (ranks[k] < 0)
        throw InputError("the contact matrix has a column for unknown " + std::to_string(wanted[k]) +
                         ", which no subdomain has.");
  });
}

/// The nodes with entries in B, of all bodies, ascending, on every rank. Collective.
std::vector<GlobalOrdinal> nodesOf(const CrsMatrix& b, int components) {
  const Map& columns = *b.getColMap();
  std::vector<GlobalOrdinal> nodes;
  for (const GlobalOrdinal unknown : localIndices(columns))
    nodes.push_back(unknown / components);
  nodes = gatherOnAll(*columns.getComm(), nodes);
  sortUnique(nodes);
  return nodes;
}

/// A node of one of this rank's subdomains.
struct Place {
  std::size_t subdomain, node;
};

/// Where this rank's subdomains have some nodes, subdomain by subdomain.
std::vector<Place> placesOf(const Substructures& all, std::span<const GlobalOrdinal> wanted) {
  std::vector<Place> places;
  for (std::size_t s = 0; s < all.size(); ++s) {
    const std::vector<GlobalOrdinal>& nodes = all.subdomains[s].nodes;
    const GlobalOrdinal first = all.globalNode(s, 0) - nodes.front(); // of the body
    auto node = nodes.begin();
    for (auto next = std::lower_bound(wanted.begin(), wanted.end(), first + nodes.front());
         next != wanted.end() && *next <= first + nodes.back(); ++next) {
      node = std::lower_bound(node, nodes.end(), *next - first);
      if (*node == *next - first)
        places.push_back({s, static_cast<std::size_t>(node - nodes.begin())});
    }
  }
  return places;
}

/// The columns of B at some places, as rows; of those only that are in its domain. Collective.
RCP<const CrsMatrix> columnsAt(const CrsMatrix& b, const Substructures& all, std::span<const Place> places) {
  std::vector<GlobalOrdinal> unknowns;
  for (const Place& place : places)
    for (int c = 0; c < all.components; ++c)
      unknowns.push_back(all.globalUnknown(place.subdomain, place.node, c));
  sortUnique(unknowns);
  const RCP<const CrsMatrix> transposed =
      Tpetra::RowMatrixTransposer<Scalar>(Teuchos::rcpFromRef(b)).createTranspose();
  const Map& domain = *transposed->getRowMap();
  std::vector<int> ranks(unknowns.size());
  domain.getRemoteIndexList(Teuchos::arrayViewFromVector(unknowns), Teuchos::arrayViewFromVector(ranks));
  std::vector<GlobalOrdinal> known;
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    if (ranks[k] >= 0)
      known.push_back(unknowns[k]);
  const RCP<const Map> here = mapInOrder(known, all.comm);
  const Import plan(transposed->getRowMap(), here);
  return Tpetra::importAndFillCompleteCrsMatrix<CrsMatrix>(transposed, plan, b.getRangeMap(), here);
}

/// The share δ_i / Σ δ_i that each copy has in the mean of its node, component by component, of the copies at
/// some places; 1 where there is one copy that counts. Collective.
std::vector<double> sharesAt(const Substructures& all, const SharedNodes& shared,
                             const Crosspoints& crosspoints, std::span<const Place> places) {
  std::vector<char> isWanted(shared.numNodes(), 0);
  std::vector<double> own(shared.numCopies() * all.components, 0.0);
  const auto meanAt = [&](const Place& place) { // the copy, where contact acts on a mean
    return crosspoints.isCrosspoint(place.subdomain, place.node) ? std::nullopt
                                                                 : shared.find(place.subdomain, place.node);
  };
  for (const Place& place : places)
    if (const auto copy = meanAt(place)) {
      isWanted[shared.copy(*copy).node] = 1;
      diagonalAt(*all.nodal[place.subdomain].stiffness, all.unknownsAt(place.subdomain, place.node),
                 std::span(own).subspan(*copy * all.components, all.components));
    }
  const std::vector<double> stiffness =
      shared.exchange(std::move(own), all.components, [&](std::size_t node) { return isWanted[node] != 0; });
  std::vector<double> shares;
  for (const Place& place : places)
    for (int c = 0; c < all.components; ++c) {
      const auto copy = meanAt(place);
      if (!copy) {
        shares.push_back(shared.isLowest(place.subdomain, place.node) ? 1 : 0);
        continue;
      }
      const std::size_t node = shared.copy(*copy).node;
      double sum = 0;
      for (std::size_t order = 0; order < shared.subdomainsAt(node).size(); ++order)
        sum += stiffness[shared.slot(node, order) * all.components + c];
      shares.push_back(stiffness[*copy * all.components + c] / sum);
    }
  return shares;
}

/// Sums of values given by global rows, on the row map of B. Collective.
RCP<const Vector> summed(const std::vector<std::pair<GlobalOrdinal, double>>& values,
                         const RCP<const Map>& rows) {
  std::vector<GlobalOrdinal> named;
  for (const auto& [row, value] : values)
    named.push_back(row);
  const RCP<const Map> map = makeMap(std::move(named), rows->getComm());
  Vector here(map);
  for (const auto& [row, value] : values)
    here.sumIntoGlobalValue(row, value);
  const RCP<Vector> result = rcp(new Vector(rows));
  result->doExport(here, Export(map, rows), Tpetra::ADD);
  return result;
}

} // namespace

void requireSound(const ConstraintMatrix& contact, const RCP<const Map>& unknowns) {
  collectively(*unknowns->getComm(), [&] {
    if (!contact.rows->isFillComplete())
      throw InputError(
          "the contact matrix must be fill-complete; call fillComplete with a map of the unknowns "
          "as domain first.");
    requireRows(contact);
  });
  if (contact.gap.is_null() || !contact.gap->getMap()->isSameAs(*contact.rows->getRowMap()))
    throw InputError("the gaps of contact must lie on the row map of the contact matrix.");
  if (!contact.rows->getRangeMap()->isSameAs(*contact.rows->getRowMap()))
    throw InputError("the range map of the contact matrix must be its row map.");
  requireColumns(*contact.rows, *unknowns);
}

ContactRows contactRows(const Substructures& all, const SharedNodes& shared, const Crosspoints& crosspoints,
                        const ConstraintMatrix& contact) {
  const std::vector<Place> places = placesOf(all, nodesOf(*contact.rows, all.components));
  const RCP<const CrsMatrix> columns = columnsAt(*contact.rows, all, places);
  const std::vector<double> shares = sharesAt(all, shared, crosspoints, places);
  const std::vector<std::vector<RowEntry>> none(all.size());
  ContactRows result{none, none, Teuchos::null};
  std::vector<std::pair<GlobalOrdinal, double>> held;
  typename CrsMatrix::local_inds_host_view_type rows;
  typename CrsMatrix::values_host_view_type values;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto& [s, node] = places[k];
    for (int c = 0; c < all.components; ++c) {
      const GlobalOrdinal unknown = all.globalUnknown(s, node, c);
      if (!columns->getRowMap()->isNodeGlobalElement(unknown))
        continue;
      columns->getLocalRowView(columns->getRowMap()->getLocalElement(unknown), rows, values);
      const int free = all.unknownsAt(s, node)[c];
      const double share = shares[k * all.components + c],
                   prescribed = all.data[s].prescribed[node * all.components + c];
      for (std::size_t entry = 0; entry < rows.extent(0); ++entry) {
        const GlobalOrdinal row = columns->getColMap()->getGlobalElement(rows(entry));
        if (values(entry) == 0)
          continue;
        if (free < 0 && shared.isLowest(s, node)) {
          held.emplace_back(row, values(entry) * prescribed);
          result.heldRows[s].push_back({row, static_cast<int>(node) * all.components + c, values(entry)});
        } else if (free >= 0 && share != 0)
          result.rows[s].push_back({row, free, share * values(entry)});
      }
    }
  }
  result.held = summed(held, contact.rows->getRowMap());
  return result;
}

} // namespace epafi::decomposition
