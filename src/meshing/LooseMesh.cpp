#include "epafi/meshing/LooseMesh.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace epafi::meshing {
namespace {

constexpr std::size_t groupsEach = 32; ///< bits of a number that stand for groups
constexpr std::size_t groupsAt = 2;    ///< where they stand in a record

std::size_t placeOf(const std::string& name, const std::vector<std::string>& names) {
  return std::lower_bound(names.begin(), names.end(), name) - names.begin();
}

/// Collective.
mesh::CellType commonType(std::span<const MeshShare> shares, const Comm& comm) {
  int least = std::numeric_limits<int>::max(), most = -1;
  for (const MeshShare& share : shares) {
    least = std::min(least, static_cast<int>(share.mesh->cellType()));
    most = std::max(most, static_cast<int>(share.mesh->cellType()));
  }
  least = minOverRanks(comm, least);
  most = maxOverRanks(comm, most);
  const auto a = static_cast<mesh::CellType>(least), b = static_cast<mesh::CellType>(most);
  if (cellOf(b, static_cast<std::size_t>(numNodesOf(a))) != a)
    throw InputError(std::string("its mesh files hold ") + toString(a) + "s and " + toString(b) +
                     "s, which do not go together; mesh all of it in one order, and hexahedra of order 2 "
                     "beside others without nodes on their faces");
  return b;
}

/// Takes shares in.
class Collector {
public:
  Collector(LooseMesh& loose, GlobalOrdinal nextElement, int nextPart)
      : loose_(loose), nextElement_(nextElement), nextPart_(nextPart) {}
  void add(const MeshShare& share);

private:
  void addElements(const MeshShare& share);

  LooseMesh& loose_;
  GlobalOrdinal nextElement_; ///< of the body
  int nextPart_;
};

void Collector::add(const MeshShare& share) {
  const std::size_t first = loose_.elements.size();
  addElements(share);
  for (const std::string& name : share.mesh->groupNames())
    for (const GlobalOrdinal element : share.mesh->group(name))
      loose_.elements.setIn(first + element, placeOf(name, loose_.groups));
  nextElement_ += share.mesh->numElements();
  nextPart_ += share.partition->numParts();
}

void Collector::addElements(const MeshShare& share) {
  const mesh::Mesh& mesh = *share.mesh;
  std::vector<bool> isCorner(mesh.numNodes(), false);
  std::vector<GlobalOrdinal> keys;
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const mesh::ElementNodes nodes(mesh, element);
    keys.clear();
    const std::size_t corners = numCornersOf(nodes.type());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      keys.push_back(share.keyOf(nodes[i]));
      if (i < corners)
        isCorner[nodes[i]] = true;
    }
    loose_.elements.add(nextElement_ + element, nextPart_ + share.partition->partOf(element), keys);
  }
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    loose_.nodes.push_back({share.keyOf(node), mesh.point(node), isCorner[node]});
}

} // namespace

std::vector<std::string> allNames(const std::set<std::string>& own, const Comm& comm) {
  const std::vector<char> all = gatherOnAll(comm, asLines(own));
  const std::vector<std::string> lines = linesOf({all.data(), all.size()});
  const std::set<std::string> names(lines.begin(), lines.end());
  return {names.begin(), names.end()};
}

FacetList gathered(const FacetList& own, const Comm& comm) {
  FacetList all;
  all.names = allNames({own.names.begin(), own.names.end()}, comm);
  std::vector<NamedFacet> renamed(own.facets);
  for (NamedFacet& facet : renamed)
    facet.surface = static_cast<int>(placeOf(own.names[facet.surface], all.names));
  all.facets = gatherOnAll(comm, renamed);
  return all;
}

void FacetList::add(const std::string& surface, std::span<const GlobalOrdinal> corners) {
  if (names.empty() || names.back() != surface)
    names.push_back(surface);
  NamedFacet& facet = facets.emplace_back();
  facet.surface = static_cast<int>(names.size()) - 1;
  facet.corners.fill(-1);
  std::copy(corners.begin(), corners.end(), facet.corners.begin());
}

LooseElements::LooseElements(std::size_t numGroups, std::size_t numNodes)
    : nodesAt_(groupsAt + (numGroups + groupsEach - 1) / groupsEach), width_(nodesAt_ + numNodes) {}

LooseElements LooseElements::none() const {
  LooseElements elements(0, 0);
  elements.nodesAt_ = nodesAt_;
  elements.width_ = width_;
  return elements;
}

void LooseElements::add(GlobalOrdinal number, int part, std::span<const GlobalOrdinal> nodes) {
  values_.push_back(number);
  values_.push_back(part);
  values_.insert(values_.end(), nodesAt_ - groupsAt, 0);
  const std::size_t first = values_.size();
  values_.insert(values_.end(), nodes.begin(), nodes.end());
  mesh::fillRow(values_, first, width_ - nodesAt_);
}

void LooseElements::setIn(std::size_t place, std::size_t group) {
  values_[place * width_ + groupsAt + group / groupsEach] |= GlobalOrdinal{1} << (group % groupsEach);
}

bool LooseElements::isIn(std::size_t place, std::size_t group) const {
  return (record(place)[groupsAt + group / groupsEach] >> (group % groupsEach) & 1) != 0;
}

void LooseElements::append(std::span<const GlobalOrdinal> records) {
  values_.insert(values_.end(), records.begin(), records.end());
}

void LooseElements::sort() {
  std::vector<std::size_t> order(size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return number(a) < number(b); });
  order.erase(std::unique(order.begin(), order.end(),
                          [&](std::size_t a, std::size_t b) { return number(a) == number(b); }),
              order.end());
  std::vector<GlobalOrdinal> sorted;
  sorted.reserve(order.size() * width_);
  for (const std::size_t place : order)
    sorted.insert(sorted.end(), record(place).begin(), record(place).end());
  values_ = std::move(sorted);
}

LooseMesh looseMeshOf(std::span<const MeshShare> shares, std::shared_ptr<const FacetList> facets,
                      const Comm& comm) {
  LooseMesh loose;
  loose.facets = std::move(facets);
  loose.cellType = commonType(shares, comm);
  std::set<std::string> groups;
  GlobalOrdinal numElements = 0, numNodes = 0, numParts = 0;
  for (const MeshShare& share : shares) {
    for (const std::string& name : share.mesh->groupNames())
      groups.insert(name);
    numElements += share.mesh->numElements();
    numNodes += share.mesh->numNodes();
    numParts += share.partition->numParts();
  }
  loose.groups = allNames(groups, comm);
  loose.numParts = static_cast<int>(sumOverRanks(comm, numParts));
  const GlobalOrdinal firstElement = sumBefore(comm, numElements), firstPart = sumBefore(comm, numParts);
  collectively(comm, [&] {
    loose.elements = LooseElements(loose.groups.size(), numNodesOf(loose.cellType));
    loose.elements.reserve(numElements);
    loose.nodes.reserve(numNodes);
    Collector collector(loose, firstElement, static_cast<int>(firstPart));
    for (const MeshShare& share : shares)
      collector.add(share);
  });
  return loose;
}

} // namespace epafi::meshing
