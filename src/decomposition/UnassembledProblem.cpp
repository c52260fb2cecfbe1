#include "epafi/decomposition/UnassembledProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/decomposition/BodyKernels.hpp"
#include "epafi/decomposition/Clusters.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"
#include "epafi/decomposition/EdgeEnds.hpp"
#include "epafi/decomposition/EqualMatrices.hpp"
#include "epafi/decomposition/Splitting.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace epafi::decomposition {

UnassembledProblem::UnassembledProblem(RCP<const Comm> comm, int dimension, int components,
                                       std::vector<std::string> bodies)
    : comm_(std::move(comm)) {
  if (dimension < 2 || dimension > 3)
    throw InputError("the dimension of space is " + std::to_string(dimension) + ", but must be 2 or 3.");
  if (components < 1 || components > 3)
    throw InputError("a node has " + std::to_string(components) + " unknowns, but must have 1, 2 or 3.");
  if (bodies.empty())
    throw InputError("there must be one body at least; name it.");
  problem_.comm = comm_;
  problem_.components = components;
  places_.dimension = dimension;
  for (std::string& name : bodies)
    problem_.bodies.emplace_back().name = std::move(name);
}

UnassembledProblem::UnassembledProblem(RCP<const Comm> comm, int components, std::vector<Body> bodies,
                                       NodePlaces places)
    : comm_(std::move(comm)), places_(std::move(places)) {
  problem_.comm = comm_;
  problem_.components = components;
  problem_.bodies = std::move(bodies);
}

UnassembledProblem::~UnassembledProblem() = default;

void UnassembledProblem::setClusterSizes(std::vector<int> sizes) {
  if (sizes.size() != problem_.bodies.size())
    throw InputError("there are " + std::to_string(sizes.size()) + " sizes of clusters for " +
                     std::to_string(problem_.bodies.size()) + " bodies; give one for each.");
  for (const int size : sizes)
    if (size < 0)
      throw InputError("a cluster has " + std::to_string(size) +
                       " subdomains; it must have 1 or more, or, with 0, all of a body.");
  if (crosspoints_)
    throw Error("UnassembledProblem::setClusterSizes was called after complete; call it before.");
  clusterSizes_ = std::move(sizes);
}

void UnassembledProblem::add(SubdomainMatrix matrix) {
  if (crosspoints_)
    throw Error("UnassembledProblem::add was called after complete; add all subdomains before.");
  added_.push_back(std::move(matrix));
}

void UnassembledProblem::add(Subdomain subdomain, SubdomainData data, NodalSubdomain nodal) {
  problem_.subdomains.push_back(std::move(subdomain));
  data_.subdomains_.push_back(std::move(data));
  nodal_.push_back(std::move(nodal));
}

void UnassembledProblem::setCandidates(std::vector<GlobalOrdinal> unknowns) {
  if (crosspoints_)
    throw Error("UnassembledProblem::setCandidates was called after complete; call it before.");
  candidates_ = std::move(unknowns);
}

void UnassembledProblem::requireComplete() const {
  if (!crosspoints_)
    throw Error("the UnassembledProblem is not complete; call complete first.");
}

Substructures UnassembledProblem::view() const {
  return {comm_,  problem_.components,   places_, problem_.bodies, problem_.subdomains, data_.subdomains_,
          nodal_, problem_.numSubdomains};
}

// ----------------------------------------------------------------------------------------------------------
// Completing it.

void UnassembledProblem::complete() {
  if (crosspoints_)
    throw Error("UnassembledProblem::complete was called twice.");
  const int first = firstNumber();
  const bool areKernelsKnown = places_.point != nullptr;
  if (!areKernelsKnown) {
    takeAdded(first);
    mapUnknowns();
    for (const auto* matrix : {&contact_, &ties_})
      if (*matrix)
        requireSound(**matrix, unknownMap_);
    if (friction_)
      requireSound(friction_->tangents, unknownMap_);
  }
  for (int s = 0; s < std::ssize(nodal_); ++s)
    problem_.subdomains[s].number = first + s;
  shared_ = SharedNodes(view());
  std::vector<Motions> near;
  if (!areKernelsKnown)
    near = findBodies();
  problem_.clusterOf = findClusters(view(), shared_, clusterSizes_);
  if (std::any_of(clusterSizes_.begin(), clusterSizes_.end(), [](int size) { return size > 0; })) {
    formClusters(areKernelsKnown ? rigidMotionsOf(view()) : std::move(near));
    const SharedNodes inside(view(), problem_.clusterOf);
    crosspoints_.emplace(view(), inside, shared_);
    for (std::size_t s = 0; s < nodal_.size(); ++s)
      problem_.subdomains[s].edgeEnds =
          findEdgeEnds(view(), inside, shared_, problem_.clusterOf, *crosspoints_, s);
  } else {
    problem_.clusters = clustersOfBodies(problem_.bodies);
    crosspoints_.emplace(view(), shared_, shared_);
  }
  for (const Cluster& cluster : problem_.clusters)
    problem_.kernelDimension += cluster.kernelDimension;
  split();
  nameCandidates();
  attach();
  places_ = {}; // nobody asks any more
}

/// The number of this rank's first subdomain; counts all. Collective.
int UnassembledProblem::firstNumber() {
  const int mine = static_cast<int>(added_.size() + nodal_.size());
  problem_.numSubdomains = sumOverRanks(*comm_, mine);
  return static_cast<int>(sumBefore(*comm_, mine));
}

/// The subdomains in the order of their nodes, prescribed unknowns taken out; near-kernels stay. Collective.
void UnassembledProblem::takeAdded(int first) {
  const auto points = std::make_shared<std::unordered_map<GlobalOrdinal, Point>>();
  collectively(*comm_, [&] {
    if (problem_.numSubdomains == 0)
      throw InputError("no rank has added a subdomain; call add first.");
    EqualMatrices known;
    for (SubdomainMatrix& matrix : added_) {
      const int components = problem_.components, number = first + static_cast<int>(own_.size());
      requireSound(matrix, places_.dimension, components, static_cast<int>(problem_.bodies.size()),
                   "subdomain " + std::to_string(number));
      Subdomain subdomain;
      SubdomainData data;
      NodalSubdomain nodal;
      own_.push_back(takeSubdomain(matrix, components, subdomain, data, nodal));
      SparseMatrix free = freeStiffness(matrix.stiffness, own_.back());
      nodal.stiffness = known.store(free);
      for (std::size_t i = 0; i < matrix.unknowns.size(); ++i)
        points->try_emplace(matrix.unknowns[i] / components, pointAt(matrix.coordinates, i));
      const std::vector<GlobalOrdinal>& nodes = subdomain.nodes;
      nodal.borderNodes.resize(nodes.size()); // nobody knows which others share
      std::iota(nodal.borderNodes.begin(), nodal.borderNodes.end(), 0);
      for (const GlobalOrdinal wanted : matrix.crosspoints)
        nodal.crosspoints.push_back(std::lower_bound(nodes.begin(), nodes.end(), wanted) - nodes.begin());
      add(std::move(subdomain), std::move(data), std::move(nodal));
    }
  });
  places_.point = [points](int /*body*/, GlobalOrdinal node) { return points->at(node); };
}

/// All that this rank's subdomains have. Collective.
RCP<const Map> UnassembledProblem::ownUnknowns() const {
  std::vector<GlobalOrdinal> here;
  for (const OwnSubdomain& own : own_)
    here.insert(here.end(), own.unknowns.begin(), own.unknowns.end());
  return makeMap(std::move(here), comm_);
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

/// Kernels of the bodies, once it is known that each is in one piece; returns near-kernels. Collective.
std::vector<Motions> UnassembledProblem::findBodies() {
  requireConnected(view(), shared_);
  BodyKernels found = findKernels(view(), added_, own_);
  std::vector<SubdomainMatrix>().swap(added_);
  problem_.bodies = std::move(found.bodies);
  for (std::size_t s = 0; s < found.kernels.size(); ++s)
    problem_.subdomains[s].kernel = std::move(found.kernels[s]);
  return std::move(found.near);
}

/// Clusters with kernels of their own, which take the place of the bodies'. Collective.
void UnassembledProblem::formClusters(std::vector<Motions> near) {
  ClusterKernels found = findClusterKernels(view(), std::move(near), problem_.clusterOf);
  problem_.clusters = std::move(found.clusters);
  for (std::size_t s = 0; s < found.kernels.size(); ++s)
    problem_.subdomains[s].kernel = std::move(found.kernels[s]);
}

/// Splits unknowns in remainder and crosspoint values, and makes averages unknowns.
void UnassembledProblem::split() {
  Splitting splitting = splitUnknowns(view(), shared_, *crosspoints_);
  AverageBasis basis;
  GlobalOrdinal positions = 0, remainders = 0;
  for (std::size_t s = 0; s < nodal_.size(); ++s) {
    const std::vector<Average> averages = averagesOf(view(), s, crosspoints_->averages(s));
    Subdomain& subdomain = problem_.subdomains[s];
    subdomain.remainderUnknowns = std::move(splitting.subdomains[s].remainderUnknowns);
    subdomain.crosspointUnknowns = std::move(splitting.subdomains[s].crosspointUnknowns);
    subdomain.crosspointIndices = std::move(splitting.subdomains[s].crosspointIndices);
    subdomain.averages = averages;
    subdomain.stiffness = basis.changed(averages, nodal_[s].stiffness);
    SubdomainData& data = data_.subdomains_[s];
    data.load = loadInBasisOf(averages, std::move(data.load));
    data.reaction = loadInBasisOf(averages, std::move(data.reaction));
    subdomain.kernel = kernelInBasisOf(averages, std::move(subdomain.kernel));
    positions += problem_.numPositions(subdomain);
    remainders += subdomain.remainderUnknowns.size();
  }
  problem_.numCrosspoints = crosspoints_->numNodes();
  problem_.primalDimension = sumOverRanks(*comm_, positions);
  problem_.crosspointMap = makeMap(std::move(splitting.ownedCrosspoints), comm_);
  problem_.remainderMap =
      rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), remainders, 0, comm_));
}

} // namespace epafi::decomposition
