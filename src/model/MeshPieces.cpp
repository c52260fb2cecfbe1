#include "epafi/model/MeshPieces.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/PointToPoint.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/decomposition/Clusters.hpp"
#include "epafi/mesh/MeshPart.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace epafi::model {
namespace {

using Keys = std::vector<GlobalOrdinal>;

/// Adds a record, or the nodes of an element.
void append(Keys& keys, std::span<const GlobalOrdinal> more) {
  keys.insert(keys.end(), more.begin(), more.end());
}

/// A facet of a surface, or a node of a set, as the rank finds it that has its element.
struct FoundFacet {
  int surface = 0, place = 0; ///< of its name; among the element's facets, −1 of a node
  GlobalOrdinal element = 0;
  std::array<GlobalOrdinal, mesh::mostFacetNodes> nodes{}; ///< their keys, outwards

  [[nodiscard]] auto order() const { return std::tuple(surface, element, place, nodes[0]); }
  bool operator==(const FoundFacet& other) const { return order() == other.order(); }
  bool operator<(const FoundFacet& other) const { return order() < other.order(); }
};

class PieceMaker {
public:
  /// Takes the elements of its own parts.
  PieceMaker(meshing::LooseMesh loose, Share own, const Comm& comm);

  /// Sets the partition as well.
  mesh::PartArrays make(std::shared_ptr<const meshing::Partition>& partition);

private:
  [[nodiscard]] bool isOwn(std::size_t place) const {
    const int part = held_.part(place);
    return own_.begin <= part && part < own_.end;
  }
  /// The nodes of an element, and its facets.
  [[nodiscard]] std::span<const GlobalOrdinal> nodesOf(std::size_t place) const {
    return mesh::withoutFilling(held_.nodes(place));
  }
  [[nodiscard]] std::span<const mesh::Facet> facetsOf(std::size_t place) const {
    return mesh::facetsOf(cellOf(loose_.cellType, nodesOf(place).size()));
  }
  [[nodiscard]] std::size_t placeOf(GlobalOrdinal key) const {
    return std::lower_bound(keys_.begin(), keys_.end(), key) - keys_.begin();
  }
  void numberNodes();
  void lookThrough();
  void takeOwn();
  void takeAround();
  void markBoundary();
  void requireWhole(std::size_t element, std::size_t facet, std::size_t other) const;
  void requireJoined() const;
  void findFacet(const meshing::NamedFacet& facet);
  void takeSurfaces();
  mesh::PartArrays arrays() const;
  void addSurfaces(mesh::PartArrays& part) const;
  void addNodeSets(mesh::PartArrays& part) const;

  meshing::LooseMesh loose_;
  Share own_;
  const Comm& comm_;
  meshing::NodeDirectory directory_;
  meshing::LooseElements& held_;
  Keys keys_;                                  ///< of the nodes of the held elements, ascending
  std::vector<LocalOrdinal> cells_;            ///< nodes of the held elements by their places in `keys_`
  std::optional<mesh::MeshTopology> topology_; ///< of these
  std::vector<FoundFacet> facets_;             ///< of all named surfaces
};

PieceMaker::PieceMaker(meshing::LooseMesh loose, Share own, const Comm& comm)
    : loose_(std::move(loose)), own_(own), comm_(comm), directory_(comm, std::move(loose_.nodes)),
      held_(loose_.elements) {}

mesh::PartArrays PieceMaker::make(std::shared_ptr<const meshing::Partition>& partition) {
  takeOwn();
  takeAround();
  collectively(comm_, [&] { lookThrough(); });
  markBoundary();
  requireJoined();
  takeSurfaces();
  topology_.reset();
  collectively(comm_, [&] { numberNodes(); });
  mesh::PartArrays result = arrays();
  meshing::HeldElements held{own_.begin, own_.end, result.elements, {}};
  for (std::size_t e = 0; e < held_.size(); ++e)
    held.parts.push_back(held_.part(e));
  partition = std::make_shared<const meshing::HeldPartition>(loose_.numParts, std::move(held));
  return result;
}

/// Of the held elements.
void PieceMaker::numberNodes() {
  keys_.clear();
  for (std::size_t e = 0; e < held_.size(); ++e)
    append(keys_, held_.nodes(e));
  cells_.resize(keys_.size());
  sortUnique(keys_);
  keys_.shrink_to_fit();
  auto next = cells_.begin();
  for (std::size_t e = 0; e < held_.size(); ++e)
    for (const GlobalOrdinal key : held_.nodes(e))
      *next++ = static_cast<LocalOrdinal>(placeOf(key));
}

void PieceMaker::lookThrough() {
  numberNodes();
  topology_.emplace(loose_.cellType, keys_.size(), cells_);
}

void PieceMaker::takeOwn() {
  const std::vector<int> ends = gatherOnAll(comm_, std::array{own_.end});
  std::map<int, Keys> outgoing;
  for (std::size_t e = 0; e < held_.size(); ++e) {
    const auto owner = std::upper_bound(ends.begin(), ends.end(), held_.part(e)) - ends.begin();
    append(outgoing[static_cast<int>(owner)], held_.record(e));
  }
  held_ = held_.none();
  for (const auto& [rank, records] : deliver(comm_, std::move(outgoing)))
    held_.append(records);
}

/// Ranks that share nodes hand each other their elements there.
void PieceMaker::takeAround() {
  collectively(comm_, [&] { lookThrough(); });
  std::map<int, Keys> outgoing;
  std::set<int> senders;
  for (const auto& [rank, shared] : directory_.shared(keys_)) {
    Keys& message = outgoing[rank];
    senders.insert(rank);
    std::vector<LocalOrdinal> touching;
    for (const GlobalOrdinal key : shared)
      for (const LocalOrdinal element : topology_->elementsOf(placeOf(key)))
        touching.push_back(element);
    sortUnique(touching);
    for (const LocalOrdinal element : touching)
      append(message, held_.record(index(element)));
  }
  for (const auto& [rank, records] : exchange(comm_, outgoing, senders))
    held_.append(records);
  collectively(comm_, [&] { held_.sort(); });
}

/// All facets at the own elements' nodes are here.
void PieceMaker::markBoundary() {
  Keys onBoundary;
  for (std::size_t e = 0; e < held_.size(); ++e)
    if (isOwn(e))
      for (const GlobalOrdinal key : held_.nodes(e))
        if (topology_->isOnBoundary(placeOf(key)))
          onBoundary.push_back(key);
  sortUnique(onBoundary);
  directory_.markBoundary(onBoundary);
}

/// Two elements that share the corners of a facet share all its nodes.
void PieceMaker::requireWhole(std::size_t element, std::size_t facet, std::size_t other) const {
  const auto nodes = held_.nodes(element), others = held_.nodes(other);
  for (const int place : facetsOf(element)[facet])
    if (std::find(others.begin(), others.end(), nodes[index(place)]) == others.end())
      throw InputError("two elements share the corners of a facet, but not node " +
                       std::to_string(nodes[index(place)]) +
                       " between them, so that the body is cut there; mesh anew");
}

void PieceMaker::requireJoined() const {
  std::vector<decomposition::Link> links;
  collectively(comm_, [&] {
    if (const auto& crowd = topology_->crowdedFacet())
      throw InputError("three of its elements share a facet, one of them with node " +
                       std::to_string(held_.nodes(index(crowd->front())).front()) +
                       "; mesh anew, and let no two files hold the same elements");
    std::set<std::pair<int, int>> pairs;
    for (std::size_t e = 0; e < held_.size(); ++e)
      for (std::size_t f = 0; isOwn(e) && f < facetsOf(e).size(); ++f) {
        const LocalOrdinal other = topology_->across(e, f);
        if (other < 0)
          continue;
        requireWhole(e, f, index(other));
        if (held_.part(index(other)) > held_.part(e))
          pairs.emplace(held_.part(e), held_.part(index(other)));
      }
    for (const auto& [part, other] : pairs)
      links.push_back({part, other});
  });

  const std::vector<int> pieces = decomposition::piecesOf(index(loose_.numParts), gatherOnAll(comm_, links));
  const auto strays = pieces.size() - index(std::count(pieces.begin(), pieces.end(), 0));
  if (strays > 0)
    throw InputError(std::to_string(strays) + " of its " + std::to_string(pieces.size()) +
                     " parts are not joined with the others in whole " +
                     (dimensionOf(loose_.cellType) == 2 ? "edges" : "faces") +
                     "; make each piece a body of its own, or join the pieces in the mesh");
}

/// Of an own element, if any has it.
void PieceMaker::findFacet(const meshing::NamedFacet& facet) {
  const std::size_t first = placeOf(facet.corners[0]);
  if (first == keys_.size() || keys_[first] != facet.corners[0])
    return;
  if (facet.corners[1] < 0) {
    for (const LocalOrdinal element : topology_->elementsOf(first))
      if (isOwn(index(element)))
        facets_.push_back({facet.surface, -1, held_.number(index(element)), {facet.corners[0]}});
    return;
  }
  const auto perFacet =
      std::count_if(facet.corners.begin(), facet.corners.end(), [](auto key) { return key >= 0; });
  const auto isCorner = [&](GlobalOrdinal key) {
    return std::find(facet.corners.begin(), facet.corners.end(), key) != facet.corners.end();
  };
  for (const LocalOrdinal element : topology_->elementsOf(first)) {
    const auto nodes = held_.nodes(index(element));
    const auto facets = facetsOf(index(element));
    for (std::size_t f = 0; isOwn(index(element)) && f < facets.size(); ++f) {
      if (numCornersOf(facets[f].type) != perFacet ||
          !std::all_of(facets[f].begin(), facets[f].begin() + perFacet,
                       [&](int node) { return isCorner(nodes[index(node)]); }))
        continue;
      if (topology_->across(element, f) >= 0)
        throw InputError("the surface '" + loose_.facets->names[index(facet.surface)] +
                         "' has a facet with node " + std::to_string(facet.corners[0]) +
                         ", which lies inside the body; a surface belongs to the boundary, so take this part "
                         "out of the physical group");
      FoundFacet& found = facets_.emplace_back();
      found = {facet.surface, static_cast<int>(f), held_.number(index(element)), {}};
      found.nodes.fill(nodes[index(facets[f].nodes.back())]);
      std::transform(facets[f].begin(), facets[f].end(), found.nodes.begin(),
                     [&](int node) { return nodes[index(node)]; });
    }
  }
}

/// All surfaces and sets of nodes, and the elements at them.
void PieceMaker::takeSurfaces() {
  Keys records;
  collectively(comm_, [&] {
    for (const meshing::NamedFacet& facet : loose_.facets->facets)
      findFacet(facet);
    Keys at;
    for (const FoundFacet& facet : facets_)
      at.push_back(facet.element);
    sortUnique(at);
    for (std::size_t e = 0, next = 0; e < held_.size() && next < at.size(); ++e)
      if (held_.number(e) == at[next]) {
        append(records, held_.record(e));
        ++next;
      }
  });
  facets_ = gatherOnAll(comm_, facets_);
  held_.append(gatherOnAll(comm_, records));
  collectively(comm_, [&] {
    held_.sort();
    sortUnique(facets_);
  });
}

void PieceMaker::addSurfaces(mesh::PartArrays& part) const {
  int last = -1;
  for (const FoundFacet& facet : facets_) {
    if (facet.place < 0)
      continue;
    if (std::exchange(last, facet.surface) != facet.surface)
      part.surfaces.emplace_back(loose_.facets->names[index(facet.surface)],
                                 mesh::Surface{facetTypeOf(loose_.cellType), {}, {}});
    mesh::Surface& surface = part.surfaces.back().second;
    surface.elements.push_back(facet.element);
    Keys nodes;
    for (const GlobalOrdinal key : mesh::withoutFilling(std::span<const GlobalOrdinal>(facet.nodes)))
      nodes.push_back(part.nodes[placeOf(key)]);
    surface.add(nodes);
  }
}

void PieceMaker::addNodeSets(mesh::PartArrays& part) const {
  int last = -1;
  for (const FoundFacet& node : facets_) {
    if (node.place >= 0)
      continue;
    if (std::exchange(last, node.surface) != node.surface)
      part.nodeSets.emplace_back(loose_.facets->names[index(node.surface)], Keys());
    part.nodeSets.back().second.push_back(part.nodes[placeOf(node.nodes[0])]);
  }
  for (auto& [name, nodes] : part.nodeSets)
    sortUnique(nodes);
}

mesh::PartArrays PieceMaker::arrays() const {
  mesh::PartArrays part;
  part.cellType = loose_.cellType;
  part.numNodes = directory_.numNodes();
  part.numCorners = directory_.numCorners();
  part.box = directory_.box();
  part.cells = cells_;
  std::vector<int> isUsed(loose_.groups.size(), 0); // group by group
  GlobalOrdinal numOwn = 0;
  for (std::size_t e = 0; e < held_.size(); ++e) {
    part.elements.push_back(held_.number(e));
    numOwn += isOwn(e) ? 1 : 0;
    for (std::size_t g = 0; g < isUsed.size(); ++g)
      isUsed[g] |= held_.isIn(e, g) ? 1 : 0;
  }
  part.numElements = sumOverRanks(comm_, numOwn);
  sumOverRanks(comm_, std::span<int>(isUsed));
  for (const meshing::NodeDirectory::Entry& node : directory_.find(keys_)) {
    part.nodes.push_back(node.number);
    part.points.push_back(node.point);
    part.cornerNumbers.push_back(node.corner);
    part.isOnBoundary.push_back(node.isOnBoundary ? 1 : 0);
  }
  for (std::size_t g = 0; g < isUsed.size(); ++g) {
    if (isUsed[g] == 0)
      continue;
    auto& group = part.groups.emplace_back(loose_.groups[g], Keys()).second;
    for (std::size_t e = 0; e < held_.size(); ++e)
      if (held_.isIn(e, g))
        group.push_back(held_.number(e));
  }
  addSurfaces(part);
  addNodeSets(part);
  return part;
}

} // namespace

void dealOut(meshing::LooseMesh loose, Share own, const Comm& comm, BodyLayout& piece) {
  mesh::PartArrays arrays = PieceMaker(std::move(loose), own, comm).make(piece.partition);
  collectively(comm, [&] { piece.mesh = std::make_unique<const mesh::MeshPart>(std::move(arrays)); });
}

} // namespace epafi::model
