#include "epafi/decomposition/Partition.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ConnectedParts.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <metis.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <string>

namespace epafi::decomposition {
namespace {

/// METIS on the dual graph of the mesh; the part of every element.
std::vector<int> cutByMetis(const fem::Mesh& mesh, int parts) {
  std::vector<idx_t> start{0}, neighbours;
  start.reserve(static_cast<std::size_t>(mesh.numElements()) + 1);
  neighbours.reserve(static_cast<std::size_t>(mesh.nodesPerElement() * mesh.numElements()));
  std::vector<GlobalOrdinal> adjacent;
  auto numVertices = static_cast<idx_t>(mesh.numElements());
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    mesh.elementNeighbours(element, adjacent);
    for (const GlobalOrdinal other : adjacent)
      neighbours.push_back(static_cast<idx_t>(other));
    start.push_back(static_cast<idx_t>(neighbours.size()));
  }
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_CONTIG] = 1;
  idx_t numConstraints = 1, numParts = parts, cut = 0;
  std::vector<idx_t> part(static_cast<std::size_t>(numVertices));
  const int status =
      METIS_PartGraphKway(&numVertices, &numConstraints, start.data(), neighbours.data(), nullptr, nullptr,
                          nullptr, &numParts, nullptr, nullptr, options, &cut, part.data());
  if (status != METIS_OK)
    throw InputError("METIS could not cut a mesh of " + std::to_string(numVertices) + " elements into " +
                     std::to_string(parts) + " parts (its status " + std::to_string(status) + ")");
  return {part.begin(), part.end()};
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

GridPartition::GridPartition(const fem::RectangleMesh& mesh, std::array<int, 2> counts)
    : elements_(mesh.elements()), counts_(counts) {
  const auto cut = [](int n, int m) {
    std::vector<int> partOf(static_cast<std::size_t>(n));
    for (int k = 0; k < m; ++k)
      std::fill(partOf.begin() + firstOf(k, n, m), partOf.begin() + firstOf(k + 1, n, m), k);
    return partOf;
  };
  columnOf_ = cut(elements_[0], counts_[0]);
  rowOf_ = cut(elements_[1], counts_[1]);
}

int GridPartition::partOf(GlobalOrdinal element) const {
  const GlobalOrdinal row = element / elements_[0], column = element - row * elements_[0];
  return columnOf_[static_cast<std::size_t>(column)] + rowOf_[static_cast<std::size_t>(row)] * counts_[0];
}

std::vector<GlobalOrdinal> GridPartition::elementsOf(int part) const {
  const int column = part % counts_[0], row = part / counts_[0];
  const GlobalOrdinal left = firstOf(column, elements_[0], counts_[0]),
                      right = firstOf(column + 1, elements_[0], counts_[0]),
                      bottom = firstOf(row, elements_[1], counts_[1]),
                      top = firstOf(row + 1, elements_[1], counts_[1]);
  std::vector<GlobalOrdinal> elements(static_cast<std::size_t>((right - left) * (top - bottom)));
  auto next = elements.begin();
  for (GlobalOrdinal j = bottom; j < top; ++j, next += right - left)
    std::iota(next, next + (right - left), left + j * elements_[0]);
  return elements;
}

GraphPartition::GraphPartition(const fem::Mesh& mesh, int parts, const Comm& comm)
    : part_(static_cast<std::size_t>(mesh.numElements()), 0) {
  collectively(comm, [&] {
    if (parts < 1 || parts > mesh.numElements())
      throw InputError("a mesh of " + std::to_string(mesh.numElements()) + " elements cannot be cut into " +
                       std::to_string(parts) + " parts; choose between 1 and " +
                       std::to_string(mesh.numElements()));
    if (mesh.numElements() > std::numeric_limits<idx_t>::max() / mesh.nodesPerElement())
      throw InputError("a mesh of " + std::to_string(mesh.numElements()) +
                       " elements is too large for METIS's 32-bit indices; cut the body as a grid");
    if (comm.getRank() != 0)
      return;
    if (parts > 1) {
      part_ = cutByMetis(mesh, parts);
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

} // namespace epafi::decomposition
