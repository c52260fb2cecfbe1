#include "epafi/decomposition/FillProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace epafi::decomposition {
namespace {

RCP<const Map> makeMap(std::vector<GlobalOrdinal> indices, const RCP<const Comm>& comm) {
  if (!std::is_sorted(indices.begin(), indices.end()))
    std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(indices), 0, comm));
}

/// Splits the unknowns of a piece in remainder and crosspoints, and lists the crosspoint values that this rank
/// owns: those of which no lower subdomain has a copy.
void splitUnknowns(const CrosspointNumbering& crosspoints, const Piece& piece, std::size_t components,
                   Subdomain& subdomain, std::vector<GlobalOrdinal>& ownedCrosspoints) {
  const fem::AssembledSubdomain& assembled = piece.assembled;
  subdomain.remainderUnknowns.reserve(assembled.unknownPosition.size());
  for (std::size_t node = 0; node < assembled.nodes.size(); ++node) {
    const auto unknowns = std::span(assembled.unknownOf).subspan(node * components, components);
    if (piece.isCrosspoint[node] == 0) {
      for (const int unknown : unknowns)
        if (unknown >= 0)
          subdomain.remainderUnknowns.push_back(unknown);
      continue;
    }
    const bool owned = piece.sharing.isLowest(piece.part, node);
    GlobalOrdinal index = crosspoints.firstIndex(piece.body, assembled.nodes[node]);
    for (const int unknown : unknowns)
      if (unknown >= 0) {
        subdomain.crosspointUnknowns.push_back(unknown);
        subdomain.crosspointIndices.push_back(index);
        if (owned)
          ownedCrosspoints.push_back(index);
        ++index;
      }
  }
}

/// Moves what is assembled out of a piece; what it takes to attach B stays.
void takeAssembled(Piece& piece, Subdomain& subdomain) {
  fem::AssembledSubdomain& assembled = piece.assembled;
  subdomain.body = piece.body;
  subdomain.number = piece.number;
  subdomain.nodes = std::move(assembled.nodes);
  subdomain.unknownPosition = std::move(assembled.unknownPosition);
  subdomain.stiffness = std::move(piece.stiffness);
  subdomain.load = std::move(assembled.load);
  subdomain.prescribed = std::move(assembled.prescribed);
  subdomain.energyOffset = assembled.energyOffset;
  subdomain.kernel = std::move(assembled.kernel);
}

} // namespace

std::vector<std::vector<Average>> changeBasis(const Outline& outline, std::vector<Piece>& pieces) {
  std::vector<std::vector<Average>> averages;
  AverageBasis basis;
  for (Piece& piece : pieces) {
    const BodyOutline& body = outline.bodies[static_cast<std::size_t>(piece.body)];
    averages.push_back(averagesOf(piece, static_cast<std::size_t>(body.components)));
    changeBasisOfRows(averages.back(), 0, piece.rows);
    basis.change(averages.back(), piece);
  }
  return averages;
}

void fillSubdomains(const Outline& outline, const CrosspointNumbering& crosspoints,
                    const std::vector<std::vector<Average>>& averages, std::vector<Piece>& pieces,
                    DecomposedProblem& problem) {
  GlobalOrdinal positions = 0, remainders = 0;
  std::vector<GlobalOrdinal> ownedCrosspoints;
  problem.subdomains.resize(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    Subdomain& subdomain = problem.subdomains[p];
    const BodyOutline& body = outline.bodies[static_cast<std::size_t>(pieces[p].body)];
    splitUnknowns(crosspoints, pieces[p], static_cast<std::size_t>(body.components), subdomain,
                  ownedCrosspoints);
    takeAssembled(pieces[p], subdomain);
    subdomain.averages = averages[p];
    positions += subdomain.prescribed.size();
    remainders += static_cast<GlobalOrdinal>(subdomain.remainderUnknowns.size());
  }
  problem.numCrosspoints = crosspoints.numNodes();
  problem.primalDimension = sumOverRanks(*problem.comm, positions);
  problem.crosspointMap = makeMap(std::move(ownedCrosspoints), problem.comm);
  problem.remainderMap = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                     static_cast<std::size_t>(remainders), 0, problem.comm));
}

void attachRows(const Rows& contact, const Rows& gluing, const std::vector<Piece>& pieces,
                DecomposedProblem& problem) {
  const auto both = [](const std::vector<GlobalOrdinal>& a, const std::vector<GlobalOrdinal>& b) {
    std::vector<GlobalOrdinal> joined;
    joined.reserve(a.size() + b.size());
    joined.insert(joined.end(), a.begin(), a.end());
    joined.insert(joined.end(), b.begin(), b.end());
    return joined;
  };
  problem.multiplierMap = makeMap(both(contact.owned, gluing.owned), problem.comm);
  problem.multiplierGhostMap = makeMap(both(contact.touched, gluing.touched), problem.comm);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    std::vector<ConstraintEntry>& constraint = problem.subdomains[p].constraint;
    constraint.clear();
    constraint.reserve(pieces[p].rows.size());
    for (const RowEntry& entry : pieces[p].rows)
      constraint.push_back(
          {problem.multiplierGhostMap->getLocalElement(entry.row), entry.unknown, entry.coefficient});
  }
  problem.gap = rcp(new Vector(problem.multiplierMap));
}

} // namespace epafi::decomposition
