#include "epafi/decomposition/UnassembledProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/BodyKernels.hpp"
#include "epafi/decomposition/Crosspoints.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"
#include "epafi/decomposition/EqualMatrices.hpp"
#include "epafi/decomposition/FillProblem.hpp"
#include "epafi/decomposition/FloatingBodies.hpp"
#include "epafi/decomposition/GluingRows.hpp"
#include "epafi/decomposition/InterfaceEnds.hpp"
#include "epafi/decomposition/SharedNodes.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace epafi::decomposition {
namespace {

/// Of these numbers, which may be named several times. Collective.
RCP<const Map> mapOf(std::vector<GlobalOrdinal> numbers, const RCP<const Comm>& comm) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(numbers), 0, comm));
}

bool hasSamePattern(const SparseMatrix& a, const SparseMatrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

} // namespace

UnassembledProblem::UnassembledProblem(RCP<const Comm> comm, int dimension, int components,
                                       std::vector<std::string> bodies)
    : comm_(std::move(comm)), dimension_(dimension), components_(components) {
  if (dimension < 2 || dimension > 3)
    throw InputError("the dimension of space is " + std::to_string(dimension) + ", but must be 2 or 3.");
  if (components < 1 || components > 3)
    throw InputError("a node has " + std::to_string(components) + " unknowns, but must have 1, 2 or 3.");
  if (bodies.empty())
    throw InputError("there must be one body at least; name it.");
  problem_.comm = comm_;
  problem_.components = components_;
  for (std::string& name : bodies)
    problem_.bodies.push_back({std::move(name), 0, 0});
}

UnassembledProblem::~UnassembledProblem() = default;

void UnassembledProblem::add(SubdomainMatrix matrix) {
  if (!unknownMap_.is_null())
    throw Error("UnassembledProblem::add was called after complete; add all subdomains before.");
  added_.push_back(std::move(matrix));
}

void UnassembledProblem::requireComplete() const {
  if (unknownMap_.is_null())
    throw Error("the UnassembledProblem is not complete; call complete first.");
}

// ---------------------------------------------------------------------------------------------------------------------
// Completing it.

void UnassembledProblem::complete() {
  if (!unknownMap_.is_null())
    throw Error("UnassembledProblem::complete was called twice.");
  makePieces();
  mapUnknowns();
  if (contact_)
    requireSound(*contact_, unknownMap_);
  shareNodes(outline_, comm_, pieces_);
  std::vector<int> bodies;
  for (const SubdomainMatrix& matrix : added_)
    bodies.push_back(matrix.body);
  requireConnected(pieces_, bodies, outline_.numSubdomains, problem_.bodies, *comm_);
  findKernels(added_, own_, dimension_, pieces_, problem_);
  choosePoints();
  const CrosspointNumbering crosspoints(outline_, pieces_, *comm_);
  for (const Piece& piece : pieces_)
    nodal_.push_back(piece.stiffness);
  const Rows contact = enterContact();
  const std::vector<std::vector<Average>> averages = changeBasis(outline_, pieces_);
  std::vector<SubdomainMatrix>().swap(added_);
  problem_.numSubdomains = outline_.numSubdomains;
  fillSubdomains(outline_, crosspoints, averages, pieces_, problem_);
  for (std::size_t s = 0; s < pieces_.size(); ++s) {
    problem_.subdomains[s].body = bodies[s];
    pieces_[s].assembled.nodes = problem_.subdomains[s].nodes; // setContact asks for them again
    pieces_[s].assembled.prescribed = problem_.subdomains[s].prescribed;
    pieces_[s].stiffness = problem_.subdomains[s].stiffness;
  }
  attach(contact);
  outline_.bodies.front().point = {}; // nobody asks any more
}

/// Numbers the subdomains and takes what was added, without its near-kernel. Collective.
void UnassembledProblem::makePieces() {
  const int mine = static_cast<int>(added_.size());
  int last = 0;
  Teuchos::scan(*comm_, Teuchos::REDUCE_SUM, mine, Teuchos::outArg(last));
  outline_.numSubdomains = static_cast<int>(sumOverRanks(*comm_, static_cast<double>(mine)));
  pieces_.resize(added_.size());
  own_.resize(added_.size());
  const auto points = std::make_shared<std::unordered_map<GlobalOrdinal, fem::Point>>();
  GlobalOrdinal numNodes = 0;
  collectively(*comm_, [&] {
    if (outline_.numSubdomains == 0)
      throw InputError("no rank has added a subdomain; call add first.");
    EqualMatrices known;
    for (std::size_t s = 0; s < added_.size(); ++s) {
      SubdomainMatrix& matrix = added_[s];
      Piece& piece = pieces_[s];
      piece.number = piece.part = last - mine + static_cast<int>(s);
      requireSound(matrix, dimension_, components_, static_cast<int>(problem_.bodies.size()),
                   "subdomain " + std::to_string(piece.number));
      own_[s] = takeSubdomain(matrix, components_, piece.assembled);
      SparseMatrix free = freeStiffness(matrix.stiffness, own_[s]);
      piece.stiffness = known.store(free);
      for (std::size_t i = 0; i < matrix.unknowns.size(); ++i)
        points->try_emplace(matrix.unknowns[i] / components_,
                            pointAt(matrix.coordinates, static_cast<Eigen::Index>(i)));
      numNodes = std::max(numNodes, piece.assembled.nodes.back() + 1);
    }
  });
  numNodes = static_cast<GlobalOrdinal>(maxOverRanks(*comm_, static_cast<double>(numNodes)));
  outline_.bodies = {{dimension_, components_, 0, numNodes,
                      [points](GlobalOrdinal node) { return points->at(node); },
                      [](GlobalOrdinal) { return false; }}}; // findInterfaceEnds stands in for it
}

/// All that this rank's subdomains have. Collective.
RCP<const Map> UnassembledProblem::ownUnknowns() const {
  std::vector<GlobalOrdinal> here;
  for (const OwnSubdomain& own : own_)
    here.insert(here.end(), own.unknowns.begin(), own.unknowns.end());
  return mapOf(std::move(here), comm_);
}

/// The map of the unknowns, and how many copies each has. Collective.
void UnassembledProblem::mapUnknowns() {
  const RCP<const Map> map = ownUnknowns();
  unknownMap_ = Tpetra::createOneToOne(map);
  Vector copies(map);
  for (const OwnSubdomain& own : own_)
    for (const GlobalOrdinal unknown : own.unknowns)
      copies.sumIntoGlobalValue(unknown, 1.0);
  const RCP<Vector> all = rcp(new Vector(unknownMap_));
  all->doExport(copies, Export(map, unknownMap_), Tpetra::ADD);
  copies_ = all;
}

/// Crosspoints that the application asks for, and the ends of interfaces.
void UnassembledProblem::choosePoints() {
  for (std::size_t s = 0; s < pieces_.size(); ++s) {
    Piece& piece = pieces_[s];
    piece.chosen = findInterfaceEnds(outline_.bodies.front(), piece);
    const auto components = static_cast<std::size_t>(components_);
    for (const GlobalOrdinal wanted : added_[s].crosspoints) {
      const auto node = static_cast<std::size_t>(
          std::lower_bound(piece.assembled.nodes.begin(), piece.assembled.nodes.end(), wanted) -
          piece.assembled.nodes.begin());
      const auto unknowns = std::span(piece.assembled.unknownOf).subspan(node * components, components);
      if (std::any_of(unknowns.begin(), unknowns.end(), [](int unknown) { return unknown >= 0; }) &&
          std::find(piece.chosen.begin(), piece.chosen.end(), node) == piece.chosen.end())
        piece.chosen.push_back(node);
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// B, and what may change.

/// Enters B_I in the pieces, whose bases must be nodal. Collective.
Rows UnassembledProblem::enterContact() {
  for (std::size_t s = 0; s < pieces_.size(); ++s) {
    pieces_[s].rows.clear();
    pieces_[s].stiffness = nodal_[s];
  }
  problem_.numInequalities = 0;
  if (!contact_)
    return {};
  problem_.numInequalities = static_cast<GlobalOrdinal>(contact_->rows->getGlobalNumRows());
  std::vector<std::pair<GlobalOrdinal, double>> held;
  Rows rows = enterContactMatrix(outline_, *contact_, comm_, pieces_, held);
  std::vector<GlobalOrdinal> heldRows;
  for (const auto& [row, value] : held)
    heldRows.push_back(row);
  const RCP<const Map> map = mapOf(std::move(heldRows), comm_);
  Vector here(map);
  for (const auto& [row, value] : held)
    here.sumIntoGlobalValue(row, value);
  held_ = rcp(new Vector(contact_->rows->getRowMap()));
  held_->doExport(here, Export(map, held_->getMap()), Tpetra::ADD);
  return rows;
}

/// Gluing rows, B and the gaps. Precondition: the pieces' bases are changed. Collective.
void UnassembledProblem::attach(const Rows& contact) {
  const Rows gluing = gluingRows(outline_, pieces_, problem_.numInequalities, comm_, problem_.numEqualities);
  attachRows(contact, gluing, pieces_, problem_);
  for (Piece& piece : pieces_)
    std::vector<RowEntry>().swap(piece.rows);
  if (contact_)
    setGap(*contact_->gap);
}

void UnassembledProblem::setContact(const ContactMatrix& contact) {
  if (unknownMap_.is_null()) {
    contact_ = contact;
    return;
  }
  requireSound(contact, unknownMap_);
  contact_ = contact;
  const Rows rows = enterContact();
  for (std::size_t s = 0; s < pieces_.size(); ++s) {
    changeBasisOfRows(problem_.subdomains[s].averages, 0, pieces_[s].rows);
    pieces_[s].stiffness = problem_.subdomains[s].stiffness;
  }
  attach(rows);
}

void UnassembledProblem::setGap(const Vector& gap) {
  requireComplete();
  if (!contact_ || !gap.getMap()->locallySameAs(*held_->getMap()))
    throw InputError("the gaps must lie on the row map of the contact matrix.");
  const auto given = gap.getData(), held = held_->getData();
  for (Teuchos_Ordinal i = 0; i < given.size(); ++i)
    problem_.gap->replaceGlobalValue(held_->getMap()->getGlobalElement(static_cast<LocalOrdinal>(i)),
                                     given[i] - held[i]);
}

void UnassembledProblem::setLoad(std::size_t subdomain, const Eigen::VectorXd& load) {
  requireComplete();
  if (subdomain >= own_.size() || load.size() != own_[subdomain].load.size())
    throw InputError("a load of " + std::to_string(load.size()) + " numbers was given for subdomain " +
                     std::to_string(subdomain) + " of this rank's " + std::to_string(own_.size()) +
                     "; it must have one for each unknown.");
  own_[subdomain].load = load;
  refreshLoad(subdomain);
}

void UnassembledProblem::refreshLoad(std::size_t subdomain) {
  const OwnSubdomain& own = own_[subdomain];
  Subdomain& target = problem_.subdomains[subdomain];
  freeLoad(own, target.load);
  changeBasisOfLoad(target.averages, target.load);
  target.energyOffset = prescribedEnergy(own);
}

void UnassembledProblem::setMatrix(std::size_t subdomain, const SparseMatrix& stiffness) {
  requireComplete();
  const auto n = subdomain < own_.size() ? static_cast<Eigen::Index>(own_[subdomain].row.size()) : 0;
  if (stiffness.rows() != n || stiffness.cols() != n)
    throw InputError("a stiffness of " + std::to_string(stiffness.rows()) + " rows was given for subdomain " +
                     std::to_string(subdomain) + " of this rank, which has " + std::to_string(n) +
                     " unknowns.");
  OwnSubdomain& own = own_[subdomain];
  auto free = std::make_shared<SparseMatrix>(freeStiffness(stiffness, own));
  if (!hasSamePattern(*free, *nodal_[subdomain]))
    throw InputError("the new stiffness of subdomain " + std::to_string(subdomain) +
                     " of this rank has another pattern; make a problem anew for it.");
  nodal_[subdomain] = free;
  Subdomain& target = problem_.subdomains[subdomain];
  target.stiffness = AverageBasis().changed(target.averages, nodal_[subdomain]);
  pieces_[subdomain].stiffness = target.stiffness;
  own.heldForce = stiffness * own.prescribed;
  refreshLoad(subdomain);
}

// ---------------------------------------------------------------------------------------------------------------------
// Solutions in the application's numbering.

std::vector<GlobalOrdinal> UnassembledProblem::globalUnknowns(std::size_t subdomain) const {
  std::vector<GlobalOrdinal> result(
      static_cast<std::size_t>(problem_.subdomains[subdomain].prescribed.size()), -1);
  const OwnSubdomain& own = own_[subdomain];
  for (std::size_t i = 0; i < own.unknowns.size(); ++i)
    result[static_cast<std::size_t>(own.position[i])] = own.unknowns[i];
  return result;
}

Eigen::VectorXd UnassembledProblem::unknowns(std::size_t subdomain,
                                             std::span<const Eigen::VectorXd> displacement) const {
  return displacement[subdomain](own_[subdomain].position);
}

RCP<Vector> UnassembledProblem::unknowns(std::span<const Eigen::VectorXd> displacement) const {
  const RCP<const Map> map = ownUnknowns();
  Vector sums(map);
  for (std::size_t s = 0; s < own_.size(); ++s) {
    const Eigen::VectorXd u = unknowns(s, displacement);
    for (std::size_t i = 0; i < own_[s].unknowns.size(); ++i)
      sums.sumIntoGlobalValue(own_[s].unknowns[i], u[static_cast<Eigen::Index>(i)]);
  }
  const RCP<Vector> result = rcp(new Vector(unknownMap_));
  result->doExport(sums, Export(map, unknownMap_), Tpetra::ADD);
  const auto values = result->getDataNonConst();
  const auto copies = copies_->getData();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
    values[i] /= copies[i];
  return result;
}

RCP<Vector> UnassembledProblem::contactForces(const Vector& multiplier) const {
  requireComplete();
  if (!contact_)
    throw InputError("there are no forces of contact: no contact matrix was given.");
  const RCP<Vector> forces = rcp(new Vector(contact_->rows->getRowMap()));
  forces->doImport(multiplier, Import(multiplier.getMap(), forces->getMap()), Tpetra::INSERT);
  return forces;
}

} // namespace epafi::decomposition
