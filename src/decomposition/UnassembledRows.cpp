// The rows of an UnassembledProblem: B and the gaps.

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"
#include "epafi/decomposition/GluingRows.hpp"
#include "epafi/decomposition/Splitting.hpp"
#include "epafi/decomposition/UnassembledProblem.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace epafi::decomposition {
namespace {

/// Entries of rows from the first one on.
void enterRows(const Vector& given, GlobalOrdinal firstRow, Vector& values) {
  const auto entries = given.getData();
  for (LocalOrdinal i = 0; i < entries.size(); ++i)
    values.replaceGlobalValue(firstRow + given.getMap()->getGlobalElement(i), entries[i]);
}

/// Those of B_p that count what supports hold. \param entries  by positions
void enterHeld(const std::vector<RowEntry>& entries, GlobalOrdinal firstRow, HeldRows& held) {
  for (const RowEntry& entry : entries)
    if (const auto found = std::lower_bound(held.positions.begin(), held.positions.end(), entry.unknown);
        found != held.positions.end() && *found == entry.unknown)
      held.constraint.push_back({MultiplierNumber(firstRow + entry.row),
                                 static_cast<int>(found - held.positions.begin()), entry.coefficient});
}

} // namespace

/// Appends rows of contact or ties to those of B. Returns what prescribed values contribute. Collective.
RCP<const Vector> UnassembledProblem::enter(const ConstraintMatrix& matrix, GlobalOrdinal firstRow,
                                            std::vector<GlobalOrdinal>& owned,
                                            std::vector<std::vector<RowEntry>>& rows) {
  for (const GlobalOrdinal row : localIndices(*matrix.rows->getRowMap()))
    owned.push_back(firstRow + row);
  ContactRows made = contactRows(view(), shared_, *crosspoints_, matrix);
  for (std::size_t s = 0; s < rows.size(); ++s) {
    enterHeld(made.heldRows[s], firstRow, problem_.subdomains[s].held);
    for (RowEntry entry : inBasisOf(problem_.subdomains[s].averages, std::move(made.rows[s]))) {
      entry.row += firstRow;
      rows[s].push_back(entry);
    }
  }
  return made.held;
}

/// Rows of contact, ties and gluing, B and the gaps. Collective.
void UnassembledProblem::attach() {
  problem_.compliance = Teuchos::null; // it was of the rows before
  const auto numRows = [](const std::optional<ConstraintMatrix>& matrix) -> GlobalOrdinal {
    return matrix ? matrix->rows->getGlobalNumRows() : 0;
  };
  problem_.numInequalities = numRows(contact_);
  problem_.numTies = numRows(ties_);
  problem_.numFriction = friction_ ? friction_->tangents.rows->getGlobalNumRows() : 0;
  requireSoundFriction();
  std::vector<GlobalOrdinal> ownContact;
  std::vector<std::vector<RowEntry>> rows(nodal_.size());
  RCP<const Vector> heldContact, heldFriction, heldTies;
  for (Subdomain& subdomain : problem_.subdomains)
    subdomain.held.constraint.clear();
  if (contact_)
    heldContact = enter(*contact_, 0, ownContact, rows);
  if (friction_)
    heldFriction = enter(friction_->tangents, problem_.numInequalities, ownContact, rows);
  if (ties_)
    heldTies = enter(*ties_, problem_.firstTie(), ownContact, rows);
  std::vector<std::shared_ptr<const SparseMatrix>> stiffness;
  for (const Subdomain& subdomain : problem_.subdomains)
    stiffness.push_back(subdomain.stiffness);
  const GluingRows gluing = gluingRows(view(), shared_, *crosspoints_, problem_.clusterOf, stiffness,
                                       problem_.firstTie() + problem_.numTies);
  Constraints constraints = joinRows(rows, ownContact, gluing, comm_);
  problem_.numEqualities = problem_.numTies + gluing.numRows;
  problem_.multiplierMap = constraints.multiplierMap;
  problem_.multiplierGhostMap = constraints.ghostMap;
  for (std::size_t s = 0; s < nodal_.size(); ++s)
    problem_.subdomains[s].constraint = std::move(constraints.entries[s]);
  Vector gaps(problem_.multiplierMap), held(problem_.multiplierMap);
  problem_.places.clear();
  if (contact_) {
    enterRows(*contact_->gap, 0, gaps);
    enterRows(*heldContact, 0, held);
    problem_.places = contact_->places;
  }
  if (friction_) {
    enterRows(*friction_->tangents.gap, problem_.numInequalities, gaps);
    enterRows(*heldFriction, problem_.numInequalities, held);
  }
  if (ties_) {
    enterRows(*ties_->gap, problem_.firstTie(), gaps);
    enterRows(*heldTies, problem_.firstTie(), held);
  }
  placeFriction();
  data_ = ProblemData(std::move(data_.subdomains_), gaps, held);
}

/// Candidates touch what rows of contact on them would. Collective.
void UnassembledProblem::nameCandidates() {
  const GlobalOrdinal here = candidates_.size();
  if (sumOverRanks(*comm_, here) == 0)
    return;
  const RCP<const Map> map =
      rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), candidates_.size(), 0, comm_));
  const RCP<CrsMatrix> units = rcp(new CrsMatrix(map, 1));
  for (LocalOrdinal i = 0; i < std::ssize(candidates_); ++i)
    units->insertGlobalValues(map->getGlobalElement(i), Teuchos::tuple(candidates_[i]), Teuchos::tuple(1.0));
  units->fillComplete(Tpetra::createOneToOne(makeMap(std::move(candidates_), comm_)), map);
  const ConstraintMatrix rows{units, rcp(new Vector(map))};
  requireSound(rows, unknownMap_);
  ContactRows made = contactRows(view(), shared_, *crosspoints_, rows);
  for (std::size_t s = 0; s < made.rows.size(); ++s) {
    Subdomain& subdomain = problem_.subdomains[s];
    for (const RowEntry& entry : inBasisOf(subdomain.averages, std::move(made.rows[s])))
      subdomain.candidates.push_back(entry.unknown);
  }
}

void UnassembledProblem::setFriction(const FrictionRows& friction) {
  if (crosspoints_)
    requireSound(friction.tangents, unknownMap_);
  friction_ = friction;
  if (crosspoints_)
    attach();
}

/// Whether rows of friction suit those of contact, which are there. Collective.
void UnassembledProblem::requireSoundFriction() const {
  if (!friction_)
    return;
  const GlobalOrdinal tangents = problem_.components - 1;
  collectively(*comm_, [&] {
    if (tangents == 0)
      throw InputError("rows of friction were given for nodes of one component, which have no tangents.");
    if (!contact_)
      throw InputError("rows of friction were given without rows of contact; call setContact as well.");
    const auto rows = localIndices(*friction_->tangents.rows->getRowMap());
    const GlobalOrdinal numNodes = friction_->contactRows.size();
    if (rows.size() != tangents * numNodes)
      throw InputError("there are " + std::to_string(rows.size()) + " rows of friction on this rank for " +
                       std::to_string(numNodes) + " nodes; each has " + std::to_string(tangents) + ".");
    for (GlobalOrdinal node = 0; node < numNodes; ++node) {
      if (!contact_->rows->getRowMap()->isNodeGlobalElement(friction_->contactRows[node]))
        throw InputError("the row of contact " + std::to_string(friction_->contactRows[node]) +
                         " is not on the rank that has its rows of friction.");
      const GlobalOrdinal first = rows[tangents * node];
      for (GlobalOrdinal k = 0; k < tangents; ++k)
        if (rows[tangents * node + k] != first + k || first % tangents != 0)
          throw InputError("the rows of friction of a node do not follow each other from number " +
                           std::to_string(first) + " on; number them node by node.");
    }
  });
}

/// Where the multipliers of friction are. Not collective.
void UnassembledProblem::placeFriction() {
  problem_.frictionNodes.clear();
  if (!friction_)
    return;
  const auto rows = localIndices(*friction_->tangents.rows->getRowMap());
  const Map& multipliers = *problem_.multiplierMap;
  for (std::size_t node = 0; node < friction_->contactRows.size(); ++node) {
    const Teuchos_Ordinal place = node * (problem_.components - 1);
    problem_.frictionNodes.push_back(
        {OwnedMultiplier(multipliers.getLocalElement(friction_->contactRows[node])),
         OwnedMultiplier(multipliers.getLocalElement(problem_.numInequalities + rows[place]))});
  }
  std::sort(problem_.frictionNodes.begin(), problem_.frictionNodes.end(),
            [](const FrictionNode& a, const FrictionNode& b) { return a.firstTangent < b.firstTangent; });
}

} // namespace epafi::decomposition
