#include "epafi/decomposition/UnassembledProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/Crosspoints.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"
#include "epafi/decomposition/EqualMatrices.hpp"
#include "epafi/decomposition/FillProblem.hpp"
#include "epafi/decomposition/FloatingBodies.hpp"
#include "epafi/decomposition/GluingRows.hpp"
#include "epafi/decomposition/InterfaceEnds.hpp"
#include "epafi/decomposition/SharedNodes.hpp"
#include "epafi/fem/RigidModes.hpp"

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

fem::Point pointAt(const Eigen::MatrixXd& coordinates, Eigen::Index row) {
  fem::Point point{};
  for (Eigen::Index c = 0; c < coordinates.cols(); ++c)
    point[static_cast<std::size_t>(c)] = coordinates(row, c);
  return point;
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
  if (contact_)
    requireSound(*contact_, unknownMap_);
  shareNodes(outline_, comm_, pieces_);
  findKernel();
  choosePoints();
  const CrosspointNumbering crosspoints(outline_, pieces_, *comm_);
  for (const Piece& piece : pieces_)
    nodal_.push_back(piece.stiffness);
  const Rows contact = enterContact();
  const std::vector<std::vector<Average>> averages = changeBasis(outline_, pieces_);
  const std::vector<int> bodies = [&] {
    std::vector<int> result;
    for (const SubdomainMatrix& matrix : added_)
      result.push_back(matrix.body);
    return result;
  }();
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
  std::vector<GlobalOrdinal> unknowns;
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
      makePiece(matrix, piece, own_[s]);
      SparseMatrix free = freeStiffness(matrix.stiffness, own_[s]);
      piece.stiffness = known.store(free);
      for (std::size_t i = 0; i < matrix.unknowns.size(); ++i)
        points->try_emplace(matrix.unknowns[i] / components_,
                            pointAt(matrix.coordinates, static_cast<Eigen::Index>(i)));
      numNodes = std::max(numNodes, piece.assembled.nodes.back() + 1);
      unknowns.insert(unknowns.end(), matrix.unknowns.begin(), matrix.unknowns.end());
    }
  });
  numNodes = static_cast<GlobalOrdinal>(maxOverRanks(*comm_, static_cast<double>(numNodes)));
  outline_.bodies = {{dimension_, components_, 0, numNodes,
                      [points](GlobalOrdinal node) { return points->at(node); },
                      [](GlobalOrdinal) { return false; }}}; // findInterfaceEnds stands in for it

  std::vector<GlobalOrdinal> here = unknowns;
  std::sort(here.begin(), here.end());
  here.erase(std::unique(here.begin(), here.end()), here.end());
  const RCP<const Map> map = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                         Teuchos::arrayViewFromVector(here), 0, comm_));
  unknownMap_ = Tpetra::createOneToOne(map);
  Vector copies(map);
  for (const GlobalOrdinal unknown : unknowns)
    copies.sumIntoGlobalValue(unknown, 1.0);
  const RCP<Vector> all = rcp(new Vector(unknownMap_));
  all->doExport(copies, Export(map, unknownMap_), Tpetra::ADD);
  copies_ = all;
}

/// Nodes, positions, load and prescribed values.
void UnassembledProblem::makePiece(SubdomainMatrix& matrix, Piece& piece, Own& own) const {
  fem::AssembledSubdomain& assembled = piece.assembled;
  for (const GlobalOrdinal unknown : matrix.unknowns)
    assembled.nodes.push_back(unknown / components_);
  std::sort(assembled.nodes.begin(), assembled.nodes.end());
  assembled.nodes.erase(std::unique(assembled.nodes.begin(), assembled.nodes.end()), assembled.nodes.end());

  const auto n = static_cast<Eigen::Index>(matrix.unknowns.size());
  const auto numPositions = assembled.nodes.size() * static_cast<std::size_t>(components_);
  std::vector<int> unknownAt(numPositions, -1); // of the application
  own.unknowns = matrix.unknowns;
  for (std::size_t i = 0; i < own.unknowns.size(); ++i) {
    const auto node =
        std::lower_bound(assembled.nodes.begin(), assembled.nodes.end(), own.unknowns[i] / components_) -
        assembled.nodes.begin();
    own.position.push_back(
        static_cast<int>(node * components_ + static_cast<int>(own.unknowns[i] % components_)));
    unknownAt[static_cast<std::size_t>(own.position.back())] = static_cast<int>(i);
  }
  own.prescribed = Eigen::VectorXd::Zero(n);
  std::vector<char> isFree(own.unknowns.size(), 1);
  for (const auto& [unknown, value] : matrix.prescribed) {
    const auto i = static_cast<std::size_t>(std::find(own.unknowns.begin(), own.unknowns.end(), unknown) -
                                            own.unknowns.begin());
    isFree[i] = 0;
    own.prescribed[static_cast<Eigen::Index>(i)] = value;
  }
  own.row.assign(own.unknowns.size(), -1);
  assembled.unknownOf.assign(numPositions, -1);
  assembled.prescribed = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(numPositions));
  for (std::size_t position = 0; position < numPositions; ++position) {
    const int i = unknownAt[position];
    if (i < 0)
      continue;
    if (isFree[static_cast<std::size_t>(i)] == 0) {
      assembled.prescribed[static_cast<Eigen::Index>(position)] = own.prescribed[i];
      continue;
    }
    own.row[static_cast<std::size_t>(i)] = static_cast<int>(assembled.unknownPosition.size());
    assembled.unknownOf[position] = own.row[static_cast<std::size_t>(i)];
    assembled.unknownPosition.push_back(static_cast<int>(position));
  }
  own.load = std::move(matrix.load);
  own.heldForce = matrix.stiffness * own.prescribed;
  assembled.load.resize(static_cast<Eigen::Index>(assembled.unknownPosition.size()));
  for (Eigen::Index i = 0; i < n; ++i)
    if (const int row = own.row[static_cast<std::size_t>(i)]; row >= 0)
      assembled.load[row] = own.load[i] - own.heldForce[i];
  assembled.energyOffset = (0.5 * own.heldForce - own.load).dot(own.prescribed);
}

/// K^s without the rows and columns of prescribed unknowns, in the order of positions.
SparseMatrix UnassembledProblem::freeStiffness(const SparseMatrix& stiffness, const Own& own) const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(stiffness.nonZeros()));
  for (int column = 0; column < stiffness.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(stiffness, column); entry; ++entry) {
      const int i = own.row[static_cast<std::size_t>(entry.row())],
                j = own.row[static_cast<std::size_t>(column)];
      if (i >= 0 && j >= 0) { // the mean of both triangles: symmetric to the last digit
        entries.emplace_back(i, j, 0.5 * entry.value());
        entries.emplace_back(j, i, 0.5 * entry.value());
      }
    }
  const auto numFree = static_cast<Eigen::Index>(
      own.row.size() - static_cast<std::size_t>(std::count(own.row.begin(), own.row.end(), -1)));
  SparseMatrix result(numFree, numFree);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

namespace {

/// Half the largest extent, and the middle, of each body. Collective.
std::vector<std::pair<fem::Point, double>> extentsOf(const std::vector<SubdomainMatrix>& matrices,
                                                     std::size_t numBodies, const Comm& comm) {
  std::vector<std::pair<fem::Point, double>> extents;
  for (std::size_t b = 0; b < numBodies; ++b) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const SubdomainMatrix& matrix : matrices)
      if (static_cast<std::size_t>(matrix.body) == b)
        for (Eigen::Index c = 0; c < matrix.coordinates.cols(); ++c) {
          low[c] = std::min(low[c], matrix.coordinates.col(c).minCoeff());
          high[c] = std::max(high[c], matrix.coordinates.col(c).maxCoeff());
        }
    fem::Point centre{};
    double size = 0;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double from = minOverRanks(comm, low[c]), to = maxOverRanks(comm, high[c]);
      if (from > to)
        continue; // a coordinate that the space does not have, or a body without subdomains
      centre[static_cast<std::size_t>(c)] = 0.5 * (from + to);
      size = std::max(size, 0.5 * (to - from));
    }
    extents.emplace_back(centre, size > 0 ? size : 1.0);
  }
  return extents;
}

} // namespace

/// R^s, from the near-kernel that the application gave, or from rigid motions. Collective.
void UnassembledProblem::findKernel() {
  const auto extents = extentsOf(added_, problem_.bodies.size(), *comm_);
  const bool isElastic = components_ == dimension_;
  std::vector<Motions> motions;
  std::vector<double> numModes(problem_.bodies.size(), -1), isRigid(problem_.bodies.size(), 1);
  for (std::size_t s = 0; s < added_.size(); ++s) {
    const SubdomainMatrix& matrix = added_[s];
    const auto b = static_cast<std::size_t>(matrix.body);
    const fem::RigidModes rigid(isElastic ? components_ : 1, extents[b].first, extents[b].second);
    const Eigen::Index given = matrix.nearKernel.cols(),
                       number = given > 0 ? given : (isElastic ? rigid.number() : components_);
    Motions& m = motions.emplace_back(Motions{matrix.body, pieces_[s].stiffness.get(), {}});
    m.near = Eigen::MatrixXd::Zero(pieces_[s].stiffness->rows(), number);
    for (std::size_t i = 0; i < own_[s].row.size(); ++i) {
      const auto place = static_cast<Eigen::Index>(i);
      const int component = static_cast<int>(own_[s].unknowns[i] % components_);
      if (own_[s].row[i] < 0)
        continue;
      if (given > 0)
        m.near.row(own_[s].row[i]) = matrix.nearKernel.row(place);
      else if (isElastic)
        m.near.row(own_[s].row[i]) = rigid.at(pointAt(matrix.coordinates, place), component).transpose();
      else
        m.near(own_[s].row[i], component) = 1;
    }
    numModes[b] = std::max(numModes[b], static_cast<double>(number));
    isRigid[b] = isElastic && given == 0 ? isRigid[b] : 0.0;
  }
  std::vector<Eigen::MatrixXd> combinations;
  for (std::size_t b = 0; b < problem_.bodies.size(); ++b) {
    numModes[b] = maxOverRanks(*comm_, numModes[b]);
    isRigid[b] = minOverRanks(*comm_, isRigid[b]);
  }
  std::vector<int> bodies;
  for (const Motions& m : motions)
    bodies.push_back(m.body);
  collectively(*comm_, [&] {
    for (std::size_t s = 0; s < motions.size(); ++s)
      if (static_cast<double>(motions[s].near.cols()) != numModes[static_cast<std::size_t>(bodies[s])])
        throw InputError("subdomain " + std::to_string(pieces_[s].number) + " has a near-kernel of " +
                         std::to_string(motions[s].near.cols()) + " columns, another one of its body has " +
                         std::to_string(static_cast<int>(numModes[static_cast<std::size_t>(bodies[s])])) +
                         ".");
    for (std::size_t b = 0; b < numModes.size(); ++b)
      if (numModes[b] < 0)
        throw InputError("the body '" + problem_.bodies[b].name + "' has no subdomain.");
  });
  requireConnected(pieces_, bodies, outline_.numSubdomains, problem_.bodies, *comm_);
  combinations = findFreeMotions(motions, *comm_, problem_.bodies);
  problem_.kernelDimension = 0;
  for (std::size_t b = 0; b < problem_.bodies.size(); ++b) {
    Body& body = problem_.bodies[b];
    problem_.kernelDimension += body.kernelDimension;
    if (body.kernelDimension > 0 && isRigid[b] > 0 && components_ > 1) {
      const fem::RigidModes rigid(components_, extents[b].first, extents[b].second);
      const fem::Point& centre = rigid.centre();
      body.motions = {{centre[0], centre[1], centre[2]}, rigid.size(), rigid.twists() * combinations[b]};
    }
  }
  for (std::size_t s = 0; s < motions.size(); ++s)
    pieces_[s].assembled.kernel = motions[s].near * combinations[static_cast<std::size_t>(bodies[s])];
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
  std::sort(heldRows.begin(), heldRows.end());
  heldRows.erase(std::unique(heldRows.begin(), heldRows.end()), heldRows.end());
  const RCP<const Map> map = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                         Teuchos::arrayViewFromVector(heldRows), 0, comm_));
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

/// The load of the free unknowns: what prescribed values take is on the right.
void UnassembledProblem::refreshLoad(std::size_t subdomain) {
  const Own& own = own_[subdomain];
  Subdomain& target = problem_.subdomains[subdomain];
  for (std::size_t i = 0; i < own.row.size(); ++i)
    if (own.row[i] >= 0)
      target.load[own.row[i]] =
          own.load[static_cast<Eigen::Index>(i)] - own.heldForce[static_cast<Eigen::Index>(i)];
  changeBasisOfLoad(target.averages, target.load);
  target.energyOffset = (0.5 * own.heldForce - own.load).dot(own.prescribed);
}

void UnassembledProblem::setMatrix(std::size_t subdomain, const SparseMatrix& stiffness) {
  requireComplete();
  const auto n = subdomain < own_.size() ? static_cast<Eigen::Index>(own_[subdomain].row.size()) : 0;
  if (stiffness.rows() != n || stiffness.cols() != n)
    throw InputError("a stiffness of " + std::to_string(stiffness.rows()) + " rows was given for subdomain " +
                     std::to_string(subdomain) + " of this rank, which has " + std::to_string(n) +
                     " unknowns.");
  Own& own = own_[subdomain];
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
  const Own& own = own_[subdomain];
  for (std::size_t i = 0; i < own.unknowns.size(); ++i)
    result[static_cast<std::size_t>(own.position[i])] = own.unknowns[i];
  return result;
}

Eigen::VectorXd UnassembledProblem::unknowns(std::size_t subdomain,
                                             std::span<const Eigen::VectorXd> displacement) const {
  return displacement[subdomain](own_[subdomain].position);
}

RCP<Vector> UnassembledProblem::unknowns(std::span<const Eigen::VectorXd> displacement) const {
  std::vector<GlobalOrdinal> here;
  for (const Own& own : own_)
    here.insert(here.end(), own.unknowns.begin(), own.unknowns.end());
  std::sort(here.begin(), here.end());
  here.erase(std::unique(here.begin(), here.end()), here.end());
  const RCP<const Map> map = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                         Teuchos::arrayViewFromVector(here), 0, comm_));
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
