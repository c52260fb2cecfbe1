#include "epafi/meshing/Partition.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/HeldSignal.hpp"
#include "epafi/mesh/ConnectedElements.hpp"
#include "epafi/meshing/BracedParts.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <metis.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <limits>
#include <map>
#include <new>
#include <numeric>
#include <span>
#include <string>

namespace epafi::meshing {
namespace {

/// Neighbours of some elements, as METIS wants them.
struct DualGraph {
  std::vector<idx_t> start, neighbours;
};

/// \param elements  all or a piece of the mesh
DualGraph dualGraphOf(const mesh::Mesh& mesh, std::span<const GlobalOrdinal> elements) {
  std::vector<idx_t> place(mesh.numElements());
  for (idx_t i = 0; i < std::ssize(elements); ++i)
    place[elements[i]] = i;
  DualGraph graph{{0}, {}};
  graph.start.reserve(elements.size() + 1);
  graph.neighbours.reserve(mesh::facetsOf(mesh.cellType()).size() * elements.size());
  std::vector<GlobalOrdinal> adjacent;
  for (const GlobalOrdinal element : elements) {
    mesh.elementNeighbours(element, adjacent);
    for (const GlobalOrdinal other : adjacent)
      graph.neighbours.push_back(place[other]);
    graph.start.push_back(static_cast<idx_t>(graph.neighbours.size()));
  }
  return graph;
}

/// METIS would refuse in words of its own. \throws InputError
void requireConnected(const mesh::Mesh& mesh, const std::vector<std::vector<GlobalOrdinal>>& pieces) {
  if (pieces.size() > 1)
    throw InputError("only " + std::to_string(pieces.front().size()) + " of its " +
                     std::to_string(mesh.numElements()) + " elements are joined with each other in whole " +
                     (dimensionOf(mesh.cellType()) == 2 ? "edges" : "faces") +
                     ", so that it cannot be cut into parts that hang together; make each part a body of its "
                     "own, or join the parts in the mesh");
}

/// METIS on the dual graph of a piece of the mesh; the part of each of its elements.
std::vector<int> cutByMetis(const mesh::Mesh& mesh, std::span<const GlobalOrdinal> elements, int parts) {
  DualGraph graph = dualGraphOf(mesh, elements);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_CONTIG] = 1;
  auto numVertices = static_cast<idx_t>(elements.size());
  idx_t numConstraints = 1, numParts = parts, cut = 0;
  std::vector<idx_t> part(numVertices);
  // METIS takes a SIGTERM from outside for a failure of its own, and jumps out of whatever it interrupts.
  const HeldSignal held(SIGTERM);
  const int status =
      METIS_PartGraphKway(&numVertices, &numConstraints, graph.start.data(), graph.neighbours.data(), nullptr,
                          nullptr, nullptr, &numParts, nullptr, nullptr, options, &cut, part.data());
  if (status == METIS_ERROR_MEMORY)
    throw std::bad_alloc();
  if (status != METIS_OK)
    throw InputError("METIS could not cut a mesh of " + std::to_string(numVertices) + " elements into " +
                     std::to_string(parts) + " parts (its status " + std::to_string(status) + ")");
  return {part.begin(), part.end()};
}

void requireCut(const mesh::Mesh& mesh, int parts) {
  const GlobalOrdinal numElements = mesh.numElements();
  if (parts < 1 || parts > numElements)
    throw InputError("a mesh of " + std::to_string(numElements) + " elements cannot be cut into " +
                     std::to_string(parts) + " parts; choose between 1 and " + std::to_string(numElements));
  const GlobalOrdinal numFacets = mesh::facetsOf(mesh.cellType()).size();
  if (numElements > std::numeric_limits<idx_t>::max() / numFacets)
    throw InputError("a mesh of " + std::to_string(numElements) +
                     " elements is too large for METIS's 32-bit indices; cut the body as a grid");
}

/// The largest piece of every part, the first of equals.
std::map<int, std::size_t> largestPieces(const std::vector<int>& part,
                                         const std::vector<std::vector<GlobalOrdinal>>& pieces) {
  std::map<int, std::size_t> largest;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    std::size_t& best = largest.try_emplace(part[pieces[piece].front()], piece).first->second;
    if (pieces[piece].size() > pieces[best].size())
      best = piece;
  }
  return largest;
}

/// Those of all parts, by their lowest elements.
std::vector<std::vector<GlobalOrdinal>> piecesOf(const mesh::Mesh& mesh, const std::vector<int>& part) {
  const auto partOf = [&](GlobalOrdinal element) { return part[element]; };
  return mesh::connectedElements(mesh.numElements(), [&](GlobalOrdinal element, auto& found) {
    mesh.elementNeighbours(element, found);
    std::erase_if(found, [&](GlobalOrdinal other) { return partOf(other) != partOf(element); });
  });
}

/// Moves the first piece that is not the largest of its part and has neighbours to the part with which it
/// shares most facets, the lowest of equals. Returns false if there is no such piece.
bool moveStray(const mesh::Mesh& mesh, std::vector<int>& part) {
  const auto partOf = [&](GlobalOrdinal element) -> int& { return part[element]; };
  const auto pieces = piecesOf(mesh, part);
  const std::map<int, std::size_t> largest = largestPieces(part, pieces);
  std::vector<GlobalOrdinal> adjacent;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    const int own = partOf(pieces[piece].front());
    if (largest.at(own) == piece)
      continue;
    std::map<int, int> facets; // shared with each other part
    for (const GlobalOrdinal element : pieces[piece]) {
      mesh.elementNeighbours(element, adjacent);
      for (const GlobalOrdinal other : adjacent)
        if (partOf(other) != own)
          ++facets[partOf(other)];
    }
    if (facets.empty())
      continue;
    const int target = std::max_element(facets.begin(), facets.end(), [](const auto& a, const auto& b) {
                         return a.second < b.second;
                       })->first;
    for (const GlobalOrdinal element : pieces[piece])
      partOf(element) = target;
    return true;
  }
  return false;
}

/// Numbers the parts that have elements from 0, in the old order; returns how many there are.
int renumber(std::vector<int>& part) {
  std::vector<int> number(*std::max_element(part.begin(), part.end()) + 1, -1);
  for (const int p : part)
    number[p] = 0;
  int next = 0;
  for (int& fresh : number)
    if (fresh == 0)
      fresh = next++;
  for (int& p : part)
    p = number[p];
  return next;
}

/// Sorts parts along the axis on which their centres spread most, and so on in both halves, which end where
/// runs of `size` do.
void bisect(std::span<int> parts, std::size_t size, const std::vector<Point>& centres) {
  const std::size_t runs = (parts.size() + size - 1) / size;
  if (runs < 2)
    return;
  const auto at = [&](int part) -> const Point& { return centres[part]; };
  std::size_t axis = 0;
  double widest = -1;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto [low, high] =
        std::minmax_element(parts.begin(), parts.end(), [&](int a, int b) { return at(a)[d] < at(b)[d]; });
    if (const double spread = at(*high)[d] - at(*low)[d]; spread > widest * (1 + 1e-9)) {
      widest = spread;
      axis = d;
    }
  }
  const double same = 1e-9 * widest; // centres of a grid's row: their order is that of the numbers
  std::stable_sort(parts.begin(), parts.end(), [&](int a, int b) {
    const auto rounded = [&](int part) { return std::round(at(part)[axis] / (same > 0 ? same : 1)); };
    return rounded(a) != rounded(b) ? rounded(a) < rounded(b) : a < b;
  });
  const std::size_t half = runs / 2 * size;
  bisect(parts.first(half), size, centres);
  bisect(parts.subspan(half), size, centres);
}

/// Part k of m takes the columns floor(k n / m) … floor((k + 1) n / m) − 1 of n.
GlobalOrdinal firstOf(GlobalOrdinal k, int n, int m) {
  return k * n / m;
}

} // namespace

void makeConnected(const mesh::Mesh& mesh, std::vector<int>& part) {
  while (moveStray(mesh, part)) {
    // It is one with a piece of its new part now: there are fewer pieces each time.
  }
}

GroupedPartition::GroupedPartition(std::shared_ptr<const Partition> parts, const mesh::Mesh& mesh, int size)
    : parts_(std::move(parts)), order_(parts_->numParts()), number_(order_.size()) {
  std::vector<Point> centres(order_.size());
  for (int part = 0; part < std::ssize(centres); ++part) {
    const std::vector<GlobalOrdinal> elements = parts_->elementsOf(part);
    for (const GlobalOrdinal element : elements) {
      const mesh::ElementNodes nodes(mesh, element);
      for (const GlobalOrdinal node : nodes)
        for (std::size_t d = 0; d < 3; ++d)
          centres[part][d] += mesh.point(node)[d] / static_cast<double>(elements.size() * nodes.size());
    }
  }
  std::iota(order_.begin(), order_.end(), 0);
  bisect(order_, size, centres);
  for (int part = 0; part < std::ssize(order_); ++part)
    number_[order_[part]] = part;
}

GridPartition::GridPartition(const mesh::StructuredMesh& mesh, std::array<int, 3> counts)
    : elements_(mesh.elements()), counts_{counts[0], counts[1], mesh.dimension() == 3 ? counts[2] : 1} {
  const auto cut = [](int n, int m) {
    std::vector<int> partOf(n);
    for (int k = 0; k < m; ++k)
      std::fill(partOf.begin() + firstOf(k, n, m), partOf.begin() + firstOf(k + 1, n, m), k);
    return partOf;
  };
  columnOf_ = cut(elements_[0], counts_[0]);
  const std::vector<int> rowInLayer = cut(elements_[1], counts_[1]);
  rowOf_.reserve(GlobalOrdinal{elements_[1]} * elements_[2]);
  for (const int layer : cut(elements_[2], counts_[2]))
    for (const int row : rowInLayer)
      rowOf_.push_back(row + layer * counts_[1]);
}

int GridPartition::partOf(GlobalOrdinal element) const {
  const GlobalOrdinal row = element / elements_[0], column = element - row * elements_[0];
  return columnOf_[column] + rowOf_[row] * counts_[0];
}

std::vector<GlobalOrdinal> GridPartition::elementsOf(int part) const {
  const std::array<int, 3> place{part % counts_[0], part / counts_[0] % counts_[1],
                                 part / counts_[0] / counts_[1]};
  std::array<GlobalOrdinal, 3> first{}, end{};
  std::size_t size = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = firstOf(place[d], elements_[d], counts_[d]);
    end[d] = firstOf(place[d] + 1, elements_[d], counts_[d]);
    size *= end[d] - first[d];
  }
  std::vector<GlobalOrdinal> elements(size);
  auto next = elements.begin();
  const GlobalOrdinal width = end[0] - first[0];
  for (GlobalOrdinal k = first[2]; k < end[2]; ++k)
    for (GlobalOrdinal j = first[1]; j < end[1]; ++j, next += width)
      std::iota(next, next + width, first[0] + elements_[0] * (j + elements_[1] * k));
  return elements;
}

GraphPartition::GraphPartition(const mesh::Mesh& mesh, int parts, const Comm& comm, Parts kind)
    : part_(mesh.numElements(), 0) {
  collectively(comm, [&] {
    requireCut(mesh, parts);
    if (comm.getRank() != 0)
      return;
    if (parts > 1) {
      auto pieces = piecesOf(mesh, part_);
      requireConnected(mesh, pieces);
      std::sort(pieces.front().begin(), pieces.front().end());
      part_ = cutByMetis(mesh, pieces.front(), parts);
      makeConnected(mesh, part_);
      if (kind == Parts::braced)
        makeBraced(mesh, part_);
    }
    numParts_ = renumber(part_);
  });
  Teuchos::broadcast(comm, 0, 1, &numParts_);
  Teuchos::broadcast(comm, 0, static_cast<int>(part_.size()), part_.data());

  start_.assign(numParts_ + 1, 0);
  for (const int p : part_)
    ++start_[p + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  members_.resize(part_.size());
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  for (int element = 0; element < std::ssize(part_); ++element)
    members_[next[part_[element]]++] = element;
}

std::vector<GlobalOrdinal> GraphPartition::elementsOf(int part) const {
  const std::size_t p = part;
  const std::span<const int> members(members_.data() + start_[p], members_.data() + start_[p + 1]);
  return {members.begin(), members.end()};
}

std::unique_ptr<const Partition> cutPieces(const mesh::Mesh& mesh, int parts, Parts kind) {
  requireCut(mesh, parts);
  std::vector<int> part(mesh.numElements(), 0);
  int first = 0; // part of the piece
  for (std::vector<GlobalOrdinal>& piece : piecesOf(mesh, part)) {
    std::sort(piece.begin(), piece.end());
    const double share = static_cast<double>(piece.size()) / static_cast<double>(part.size());
    const int wanted = std::max(1, static_cast<int>(std::round(share * parts)));
    std::vector<int> cut(piece.size(), 0);
    if (wanted > 1)
      cut = cutByMetis(mesh, piece, wanted);
    for (std::size_t i = 0; i < piece.size(); ++i)
      part[piece[i]] = first + cut[i];
    first += wanted;
  }
  makeConnected(mesh, part);
  if (kind == Parts::braced)
    makeBraced(mesh, part);
  const int number = renumber(part);
  HeldElements held{0, number, std::vector<GlobalOrdinal>(part.size()), std::move(part)};
  std::iota(held.elements.begin(), held.elements.end(), GlobalOrdinal{0});
  return std::make_unique<const HeldPartition>(number, std::move(held));
}

HeldPartition::HeldPartition(int numParts, HeldElements held)
    : numParts_(numParts), held_(std::move(held)), own_(held_.end - held_.begin) {
  for (std::size_t e = 0; e < held_.elements.size(); ++e)
    if (const int part = held_.parts[e]; held_.begin <= part && part < held_.end)
      own_[part - held_.begin].push_back(held_.elements[e]);
}

int HeldPartition::partOf(GlobalOrdinal element) const {
  const auto found = std::lower_bound(held_.elements.begin(), held_.elements.end(), element);
  if (found == held_.elements.end() || *found != element)
    throw Error("The part of element " + std::to_string(element) +
                " is asked for on a rank that does not hold it.");
  return held_.parts[found - held_.elements.begin()];
}

std::vector<GlobalOrdinal> HeldPartition::elementsOf(int part) const {
  return own_.at(part - held_.begin);
}

} // namespace epafi::meshing
