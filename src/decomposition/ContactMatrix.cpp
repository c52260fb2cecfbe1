#include "epafi/decomposition/ContactMatrix.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/NodeShares.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_RowMatrixTransposer.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace epafi::decomposition {
namespace {

/// The unknowns of this rank's pieces, prescribed ones too, none twice.
std::vector<GlobalOrdinal> unknownsHere(const Outline& outline, const std::vector<Piece>& pieces) {
  std::vector<GlobalOrdinal> unknowns;
  const auto components = static_cast<GlobalOrdinal>(outline.bodies.front().components);
  for (const Piece& piece : pieces)
    for (const GlobalOrdinal node : piece.assembled.nodes)
      for (GlobalOrdinal c = 0; c < components; ++c)
        unknowns.push_back(node * components + c);
  std::sort(unknowns.begin(), unknowns.end());
  unknowns.erase(std::unique(unknowns.begin(), unknowns.end()), unknowns.end());
  return unknowns;
}

/// The columns of B_I of some unknowns, as rows; of those only that are in its domain. Collective.
RCP<const CrsMatrix> columnsAt(const CrsMatrix& b, std::vector<GlobalOrdinal> unknowns) {
  const RCP<const CrsMatrix> transposed =
      Tpetra::RowMatrixTransposer<Scalar>(Teuchos::rcpFromRef(b)).createTranspose();
  const Map& domain = *transposed->getRowMap();
  std::vector<int> ranks(unknowns.size());
  domain.getRemoteIndexList(Teuchos::arrayViewFromVector(unknowns), Teuchos::arrayViewFromVector(ranks));
  std::vector<GlobalOrdinal> known;
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    if (ranks[k] >= 0)
      known.push_back(unknowns[k]);
  const RCP<const Map> here = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                          Teuchos::arrayViewFromVector(known), 0, domain.getComm()));
  const Import plan(transposed->getRowMap(), here);
  return Tpetra::importAndFillCompleteCrsMatrix<CrsMatrix>(transposed, plan, b.getRangeMap(), here);
}

/// A column of B_I at a node of a piece.
struct Column {
  PieceNode at;
  std::size_t component = 0;
  std::vector<std::pair<GlobalOrdinal, double>> entries;
};

/// In the order of the pieces and their unknowns; of the columns that are not empty.
std::vector<Column> columnsOf(const Outline& outline, const CrsMatrix& columns,
                              const std::vector<Piece>& pieces) {
  std::vector<Column> result;
  const auto components = static_cast<std::size_t>(outline.bodies.front().components);
  typename CrsMatrix::local_inds_host_view_type rows;
  typename CrsMatrix::values_host_view_type values;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (std::size_t node = 0; node < pieces[p].assembled.nodes.size(); ++node)
      for (std::size_t c = 0; c < components; ++c) {
        const GlobalOrdinal unknown =
            pieces[p].assembled.nodes[node] * static_cast<GlobalOrdinal>(components) +
            static_cast<GlobalOrdinal>(c);
        if (!columns.getRowMap()->isNodeGlobalElement(unknown))
          continue;
        columns.getLocalRowView(columns.getRowMap()->getLocalElement(unknown), rows, values);
        Column column{{p, node}, c, {}};
        for (std::size_t k = 0; k < rows.extent(0); ++k)
          if (values(k) != 0)
            column.entries.emplace_back(columns.getColMap()->getGlobalElement(rows(k)), values(k));
        if (!column.entries.empty())
          result.push_back(std::move(column));
      }
  return result;
}

void requireRows(const ContactMatrix& contact) {
  const Map& rows = *contact.rows->getRowMap();
  typename CrsMatrix::local_inds_host_view_type columns;
  typename CrsMatrix::values_host_view_type values;
  const auto numRows = static_cast<GlobalOrdinal>(rows.getGlobalNumElements());
  for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(numLocal(rows)); ++row) {
    const GlobalOrdinal number = rows.getGlobalElement(row);
    if (number < 0 || number >= numRows)
      throw InputError("the contact matrix has " + std::to_string(numRows) + " rows, one of number " +
                       std::to_string(number) + "; rows must be numbered from 0 without holes.");
    contact.rows->getLocalRowView(row, columns, values);
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
  std::vector<GlobalOrdinal> wanted;
  for (LocalOrdinal k = 0; k < static_cast<LocalOrdinal>(numLocal(columns)); ++k)
    wanted.push_back(columns.getGlobalElement(k));
  std::vector<int> ranks(wanted.size());
  unknowns.getRemoteIndexList(Teuchos::arrayViewFromVector(wanted), Teuchos::arrayViewFromVector(ranks));
  collectively(*unknowns.getComm(), [&] {
    for (std::size_t k = 0; k < wanted.size(); ++k)
      if (ranks[k] < 0)
        throw InputError("the contact matrix has a column for unknown " + std::to_string(wanted[k]) +
                         ", which no subdomain has.");
  });
}

} // namespace

void requireSound(const ContactMatrix& contact, const RCP<const Map>& unknowns) {
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

Rows enterContactMatrix(const Outline& outline, const ContactMatrix& contact, const RCP<const Comm>& comm,
                        std::vector<Piece>& pieces, std::vector<std::pair<GlobalOrdinal, double>>& held) {
  const RCP<const CrsMatrix> transposed = columnsAt(*contact.rows, unknownsHere(outline, pieces));
  const std::vector<Column> columns = columnsOf(outline, *transposed, pieces);
  std::vector<PieceNode> nodes;
  for (const Column& column : columns)
    nodes.push_back(column.at);
  const NodeShares shares(outline, nodes, pieces, comm);

  Rows rows;
  const auto components = static_cast<std::size_t>(outline.bodies.front().components);
  for (const Column& column : columns) {
    Piece& piece = pieces[column.at.piece];
    const std::size_t position = column.at.node * components + column.component;
    const int unknown = piece.assembled.unknownOf[position];
    const bool isLowest = piece.sharing.isLowest(piece.part, column.at.node);
    const Eigen::RowVectorXd* share = shares.at(column.at);
    for (const auto& [row, coefficient] : column.entries) {
      if (unknown < 0) {
        if (isLowest)
          held.emplace_back(row,
                            coefficient * piece.assembled.prescribed[static_cast<Eigen::Index>(position)]);
        continue;
      }
      if (!isLowest && share == nullptr)
        continue;
      const double weight = share == nullptr ? 1.0 : (*share)[static_cast<Eigen::Index>(column.component)];
      piece.rows.push_back({row, unknown, weight * coefficient});
      rows.touched.push_back(row);
    }
  }
  const Map& owned = *contact.rows->getRowMap();
  for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(numLocal(owned)); ++row)
    rows.owned.push_back(owned.getGlobalElement(row));
  return rows;
}

} // namespace epafi::decomposition
