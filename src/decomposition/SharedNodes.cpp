#include "epafi/decomposition/SharedNodes.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/SharedValues.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_CrsGraph.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace epafi::decomposition {
namespace {

using Graph = Tpetra::CrsGraph<>;

RCP<const Map> mapOf(std::vector<GlobalOrdinal> nodes, const RCP<const Comm>& comm) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(nodes), 0, comm));
}

/// How many subdomains have each of this rank's nodes. Collective.
Vector copiesOf(const RCP<const Comm>& comm, const std::vector<Piece>& pieces) {
  std::vector<GlobalOrdinal> nodes;
  for (const Piece& piece : pieces)
    nodes.insert(nodes.end(), piece.assembled.nodes.begin(), piece.assembled.nodes.end());
  const RCP<const Map> here = mapOf(std::move(nodes), comm), owned = Tpetra::createOneToOne(here);
  Vector mine(here), all(owned);
  for (const Piece& piece : pieces)
    for (const GlobalOrdinal node : piece.assembled.nodes)
      mine.sumIntoGlobalValue(node, 1.0);
  const Export toOwners(here, owned);
  all.doExport(mine, toOwners, Tpetra::ADD);
  mine.doImport(all, toOwners, Tpetra::INSERT);
  return mine;
}

/// A row for each node of this rank that has several copies, with the numbers of all subdomains that have it. Collective.
RCP<const Graph> subdomainsAtNodes(const Outline& outline, const RCP<const Comm>& comm,
                                   const std::vector<Piece>& pieces) {
  const Vector copies = copiesOf(comm, pieces);
  std::vector<GlobalOrdinal> shared;
  collectively(*comm, [&] {
    const auto numbers = copies.getData();
    for (Teuchos_Ordinal i = 0; i < numbers.size(); ++i) {
      const GlobalOrdinal node = copies.getMap()->getGlobalElement(static_cast<LocalOrdinal>(i));
      if (numbers[i] > static_cast<double>(maxCopies))
        throw InputError("node " + std::to_string(node) + " is shared by " +
                         std::to_string(static_cast<GlobalOrdinal>(numbers[i])) + " subdomains; at most " +
                         std::to_string(maxCopies) + " may share one.");
      if (numbers[i] > 1)
        shared.push_back(node);
    }
  });
  const auto most = static_cast<std::size_t>(copies.normInf());
  const RCP<const Map> here = mapOf(std::move(shared), comm), owned = Tpetra::createOneToOne(here);
  const RCP<const Map> numbers =
      rcp(new Map(static_cast<Tpetra::global_size_t>(outline.numSubdomains), 0, comm));
  Graph mine(here, most), all(owned, most);
  for (const Piece& piece : pieces) {
    const GlobalOrdinal number = piece.number;
    for (const GlobalOrdinal node : piece.assembled.nodes)
      if (here->isNodeGlobalElement(node))
        mine.insertGlobalIndices(node, 1, &number);
  }
  mine.fillComplete(numbers, owned);
  const Export toOwners(here, owned);
  all.doExport(mine, toOwners, Tpetra::INSERT);
  all.fillComplete(numbers, owned);
  const RCP<Graph> result = rcp(new Graph(here, most));
  result->doImport(all, toOwners, Tpetra::INSERT);
  result->fillComplete(numbers, owned);
  return result;
}

/// Ascending; none if the node is not shared.
std::vector<int> subdomainsAt(const Graph& graph, GlobalOrdinal node) {
  std::vector<int> parts;
  if (!graph.getRowMap()->isNodeGlobalElement(node))
    return parts;
  typename Graph::local_inds_host_view_type columns;
  graph.getLocalRowView(graph.getRowMap()->getLocalElement(node), columns);
  for (std::size_t k = 0; k < columns.extent(0); ++k)
    parts.push_back(static_cast<int>(graph.getColMap()->getGlobalElement(columns(k))));
  std::sort(parts.begin(), parts.end());
  return parts;
}

/// Which components of a node are unknowns, as the digits of a binary number.
double unknownsAt(const Piece& piece, std::size_t node, std::size_t components) {
  double digits = 0;
  for (std::size_t c = 0; c < components; ++c)
    if (piece.assembled.unknownOf[node * components + c] >= 0)
      digits += std::exp2(static_cast<double>(c));
  return digits;
}

void requireEqualUnknowns(const Outline& outline, const RCP<const Comm>& comm,
                          const std::vector<Piece>& pieces) {
  const auto components = static_cast<std::size_t>(outline.bodies.front().components);
  std::vector<SharedNode> nodes;
  std::vector<double> digits;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    for (std::size_t k = 0; k < pieces[p].sharing.size(); ++k) {
      nodes.push_back({p, k});
      digits.push_back(unknownsAt(pieces[p], pieces[p].sharing.node(k), components));
    }
  const Eigen::Map<const Eigen::MatrixXd> own(digits.data(), static_cast<Eigen::Index>(digits.size()), 1);
  const std::vector<Eigen::MatrixXd> copies = valuesOfCopies(outline, pieces, nodes, own, comm);
  collectively(*comm, [&] {
    for (std::size_t i = 0; i < copies.size(); ++i)
      if (copies[i].minCoeff() != copies[i].maxCoeff()) {
        const Piece& piece = pieces[nodes[i].piece];
        const auto parts = piece.sharing.parts(nodes[i].place);
        throw InputError(
            "the subdomains at node " +
            std::to_string(piece.assembled.nodes[piece.sharing.node(nodes[i].place)]) + ", among them " +
            std::to_string(parts.front()) + " and " + std::to_string(parts.back()) +
            ", do not have the same free unknowns there; an unknown that is left out or prescribed in one "
            "must be so in all that share it.");
      }
  });
}

} // namespace

void shareNodes(const Outline& outline, const RCP<const Comm>& comm, std::vector<Piece>& pieces) {
  const RCP<const Graph> graph = subdomainsAtNodes(outline, comm, pieces);
  for (Piece& piece : pieces) {
    std::vector<std::size_t> nodes;
    std::vector<std::vector<int>> parts;
    for (std::size_t node = 0; node < piece.assembled.nodes.size(); ++node)
      if (std::vector<int> atNode = subdomainsAt(*graph, piece.assembled.nodes[node]); !atNode.empty()) {
        nodes.push_back(node);
        parts.push_back(std::move(atNode));
      }
    piece.sharing = Sharing(std::move(nodes), parts);
  }
  requireEqualUnknowns(outline, comm, pieces);
}

} // namespace epafi::decomposition
