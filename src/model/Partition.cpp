#include "epafi/model/Partition.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/model/ConnectedParts.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <metis.h>

#include <algorithm>
#include <csignal>
#include <limits>
#include <new>
#include <numeric>
#include <span>
#include <string>

namespace epafi::model {
namespace {

/// Neighbours of all elements, as METIS wants them.
struct DualGraph {
  std::vector<idx_t> start, neighbours;
};

DualGraph dualGraphOf(const fem::Mesh& mesh) {
  DualGraph graph{{0}, {}};
  graph.start.reserve(static_cast<std::size_t>(mesh.numElements()) + 1);
  graph.neighbours.reserve(fem::facetsOf(mesh.cellType()).size() *
                           static_cast<std::size_t>(mesh.numElements()));
  std::vector<GlobalOrdinal> adjacent;
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    mesh.elementNeighbours(element, adjacent);
    for (const GlobalOrdinal other : adjacent)
      graph.neighbours.push_back(static_cast<idx_t>(other));
    graph.start.push_back(static_cast<idx_t>(graph.neighbours.size()));
  }
  return graph;
}

/// METIS would refuse in words of its own. \throws InputError
void requireConnected(const DualGraph& graph, const fem::Mesh& mesh) {
  std::vector<char> isReached(static_cast<std::size_t>(mesh.numElements()), 0);
  std::vector<idx_t> front{0};
  isReached[0] = 1;
  GlobalOrdinal numReached = 1;
  while (!front.empty()) {
    const auto element = static_cast<std::size_t>(front.back());
    front.pop_back();
    for (idx_t k = graph.start[element]; k < graph.start[element + 1]; ++k)
      if (const idx_t other = graph.neighbours[static_cast<std::size_t>(k)];
          isReached[static_cast<std::size_t>(other)] == 0) {
        isReached[static_cast<std::size_t>(other)] = 1;
        ++numReached;
        front.push_back(other);
      }
  }
  if (numReached < mesh.numElements())
    throw InputError("only " + std::to_string(numReached) + " of its " + std::to_string(mesh.numElements()) +
                     " elements are joined with each other in whole " +
                     (dimensionOf(mesh.cellType()) == 2 ? "edges" : "faces") +
                     ", so that it cannot be cut into parts that hang together; make each part a body of its "
                     "own, or join the parts in the mesh");
}

/// METIS on the dual graph of the mesh; the part of every element.
std::vector<int> cutByMetis(const fem::Mesh& mesh, int parts, const std::vector<int>& weights) {
  DualGraph graph = dualGraphOf(mesh);
  requireConnected(graph, mesh);
  std::vector<idx_t> cost(weights.begin(), weights.end());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_CONTIG] = 1;
  auto numVertices = static_cast<idx_t>(mesh.numElements());
  idx_t numConstraints = 1, numParts = parts, cut = 0;
  std::vector<idx_t> part(static_cast<std::size_t>(numVertices));
  const auto partition = [&] {
    return METIS_PartGraphKway(&numVertices, &numConstraints, graph.start.data(), graph.neighbours.data(),
                               cost.empty() ? nullptr : cost.data(), nullptr, nullptr, &numParts, nullptr,
                               nullptr, options, &cut, part.data());
  };
  int status = partition();
  // METIS takes a SIGTERM from outside for a failure of its own: such a one is passed on to whom it was meant for.
  if (status == METIS_ERROR) {
    status = partition();
    if (status == METIS_OK)
      std::raise(SIGTERM);
  }
  if (status == METIS_ERROR_MEMORY)
    throw std::bad_alloc();
  if (status != METIS_OK)
    throw InputError("METIS could not cut a mesh of " + std::to_string(numVertices) + " elements into " +
                     std::to_string(parts) + " parts (its status " + std::to_string(status) + ")");
  return {part.begin(), part.end()};
}

void requireCut(const fem::Mesh& mesh, int parts) {
  const GlobalOrdinal numElements = mesh.numElements();
  if (parts < 1 || parts > numElements)
    throw InputError("a mesh of " + std::to_string(numElements) + " elements cannot be cut into " +
                     std::to_string(parts) + " parts; choose between 1 and " + std::to_string(numElements));
  const auto numFacets = static_cast<GlobalOrdinal>(fem::facetsOf(mesh.cellType()).size());
  if (numElements > std::numeric_limits<idx_t>::max() / numFacets)
    throw InputError("a mesh of " + std::to_string(numElements) +
                     " elements is too large for METIS's 32-bit indices; cut the body as a grid");
}

void requireWeights(const fem::Mesh& mesh, const std::vector<int>& weights) {
  if (weights.empty())
    return;
  if (static_cast<GlobalOrdinal>(weights.size()) != mesh.numElements())
    throw InputError("a mesh of " + std::to_string(mesh.numElements()) + " elements got " +
                     std::to_string(weights.size()) + " weights; give one an element, or none");
  const auto least = std::min_element(weights.begin(), weights.end());
  if (*least < 1)
    throw InputError("element " + std::to_string(least - weights.begin()) + " weighs " +
                     std::to_string(*least) + "; weights have to be at least 1");
  const GlobalOrdinal sum = std::accumulate(weights.begin(), weights.end(), GlobalOrdinal{0});
  if (sum > std::numeric_limits<idx_t>::max())
    throw InputError(
        "the elements weigh " + std::to_string(sum) + " in all, more than METIS can count; scale " +
        "the weights so that their sum is at most " + std::to_string(std::numeric_limits<idx_t>::max()));
}

/// Numbers the parts that have elements from 0, in the old order; returns how many there are.
int renumber(std::vector<int>& part) {
  std::vector<int> number(static_cast<std::size_t>(*std::max_element(part.begin(), part.end())) + 1, -1);
  for (const int p : part)
    number[static_cast<std::size_t>(p)] = 0;
  int next = 0;
  for (int& fresh : number)
    if (fresh == 0)
      fresh = next++;
  for (int& p : part)
    p = number[static_cast<std::size_t>(p)];
  return next;
}

/// Part k of m takes the columns floor(k n / m) … floor((k + 1) n / m) − 1 of n.
GlobalOrdinal firstOf(GlobalOrdinal k, int n, int m) {
  return k * n / m;
}

} // namespace

GridPartition::GridPartition(const fem::StructuredMesh& mesh, std::array<int, 3> counts)
    : elements_(mesh.elements()), counts_{counts[0], counts[1], mesh.dimension() == 3 ? counts[2] : 1} {
  const auto cut = [](int n, int m) {
    std::vector<int> partOf(static_cast<std::size_t>(n));
    for (int k = 0; k < m; ++k)
      std::fill(partOf.begin() + firstOf(k, n, m), partOf.begin() + firstOf(k + 1, n, m), k);
    return partOf;
  };
  columnOf_ = cut(elements_[0], counts_[0]);
  const std::vector<int> rowInLayer = cut(elements_[1], counts_[1]);
  rowOf_.reserve(static_cast<std::size_t>(elements_[1]) * static_cast<std::size_t>(elements_[2]));
  for (const int layer : cut(elements_[2], counts_[2]))
    for (const int row : rowInLayer)
      rowOf_.push_back(row + layer * counts_[1]);
}

int GridPartition::partOf(GlobalOrdinal element) const {
  const GlobalOrdinal row = element / elements_[0], column = element - row * elements_[0];
  return columnOf_[static_cast<std::size_t>(column)] + rowOf_[static_cast<std::size_t>(row)] * counts_[0];
}

std::vector<GlobalOrdinal> GridPartition::elementsOf(int part) const {
  const std::array<int, 3> place{part % counts_[0], part / counts_[0] % counts_[1],
                                 part / counts_[0] / counts_[1]};
  std::array<GlobalOrdinal, 3> first{}, end{};
  std::size_t size = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = firstOf(place[d], elements_[d], counts_[d]);
    end[d] = firstOf(place[d] + 1, elements_[d], counts_[d]);
    size *= static_cast<std::size_t>(end[d] - first[d]);
  }
  std::vector<GlobalOrdinal> elements(size);
  auto next = elements.begin();
  const GlobalOrdinal width = end[0] - first[0];
  for (GlobalOrdinal k = first[2]; k < end[2]; ++k)
    for (GlobalOrdinal j = first[1]; j < end[1]; ++j, next += width)
      std::iota(next, next + width, first[0] + elements_[0] * (j + elements_[1] * k));
  return elements;
}

GraphPartition::GraphPartition(const fem::Mesh& mesh, int parts, const Comm& comm,
                               const std::vector<int>& weights)
    : part_(static_cast<std::size_t>(mesh.numElements()), 0) {
  collectively(comm, [&] {
    requireCut(mesh, parts);
    if (comm.getRank() != 0)
      return;
    requireWeights(mesh, weights);
    if (parts > 1) {
      part_ = cutByMetis(mesh, parts, weights);
      makeConnected(mesh, part_);
    }
    numParts_ = renumber(part_);
  });
  Teuchos::broadcast(comm, 0, 1, &numParts_);
  Teuchos::broadcast(comm, 0, static_cast<int>(part_.size()), part_.data());

  start_.assign(static_cast<std::size_t>(numParts_) + 1, 0);
  for (const int p : part_)
    ++start_[static_cast<std::size_t>(p) + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  members_.resize(part_.size());
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t element = 0; element < part_.size(); ++element)
    members_[next[static_cast<std::size_t>(part_[element])]++] = static_cast<int>(element);
}

std::vector<GlobalOrdinal> GraphPartition::elementsOf(int part) const {
  const auto p = static_cast<std::size_t>(part);
  const std::span<const int> members(members_.data() + start_[p], members_.data() + start_[p + 1]);
  return {members.begin(), members.end()};
}

} // namespace epafi::model
