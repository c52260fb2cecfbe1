#include "epafi/decomposition/SharedValues.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <span>

namespace epafi::decomposition {
namespace {

RCP<const Map> mapOf(const std::vector<GlobalOrdinal>& keys, const RCP<const Comm>& comm) {
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(keys), 0, comm));
}

} // namespace

std::vector<GlobalOrdinal> firstNodesOf(const Outline& outline) {
  std::vector<GlobalOrdinal> first{0};
  for (const BodyOutline& body : outline.bodies)
    first.push_back(first.back() + body.numNodes);
  return first;
}

std::vector<Eigen::MatrixXd> valuesOfCopies(const Outline& outline, const std::vector<Piece>& pieces,
                                            const std::vector<SharedNode>& nodes, const Eigen::MatrixXd& own,
                                            const RCP<const Comm>& comm) {
  std::vector<Eigen::MatrixXd> values;
  if (sumOverRanks(*comm, static_cast<double>(nodes.size())) == 0)
    return values;
  const std::vector<GlobalOrdinal> firstNode = firstNodesOf(outline);
  std::vector<GlobalOrdinal> told, heard;
  for (const SharedNode& shared : nodes) {
    const Piece& piece = pieces[shared.piece];
    const std::span<const int> parts = piece.sharing.parts(shared.place);
    const GlobalOrdinal node = piece.assembled.nodes[piece.sharing.node(shared.place)];
    const GlobalOrdinal first = (firstNode[static_cast<std::size_t>(piece.body)] + node) * maxCopies;
    told.push_back(first + (std::find(parts.begin(), parts.end(), piece.part) - parts.begin()));
    for (std::size_t copy = 0; copy < parts.size(); ++copy)
      heard.push_back(first + static_cast<GlobalOrdinal>(copy));
  }
  std::sort(heard.begin(), heard.end());
  heard.erase(std::unique(heard.begin(), heard.end()), heard.end());

  const auto numColumns = static_cast<std::size_t>(own.cols());
  MultiVector mine(mapOf(told, comm), numColumns), all(mapOf(heard, comm), numColumns);
  for (std::size_t k = 0; k < numColumns; ++k) {
    const auto column = mine.getDataNonConst(k);
    for (Eigen::Index i = 0; i < own.rows(); ++i)
      column[i] = own(i, static_cast<Eigen::Index>(k));
  }
  const Import plan(mine.getMap(), all.getMap());
  all.doImport(mine, plan, Tpetra::INSERT);

  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Piece& piece = pieces[nodes[i].piece];
    const auto numCopies = static_cast<Eigen::Index>(piece.sharing.parts(nodes[i].place).size());
    const GlobalOrdinal first = told[i] / maxCopies * maxCopies;
    const auto row = std::lower_bound(heard.begin(), heard.end(), first) - heard.begin();
    Eigen::MatrixXd& copies = values.emplace_back(numCopies, own.cols());
    for (std::size_t k = 0; k < numColumns; ++k)
      for (Eigen::Index copy = 0; copy < numCopies; ++copy)
        copies(copy, static_cast<Eigen::Index>(k)) = all.getData(k)[row + copy];
  }
  return values;
}

Eigen::RowVectorXd stiffnessOf(const Piece& piece, std::size_t node, std::size_t components) {
  Eigen::RowVectorXd stiffness = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(components));
  for (std::size_t c = 0; c < components; ++c)
    if (const int unknown = piece.assembled.unknownOf[node * components + c]; unknown >= 0)
      stiffness[static_cast<Eigen::Index>(c)] = piece.stiffness->coeff(unknown, unknown);
  return stiffness;
}

} // namespace epafi::decomposition
