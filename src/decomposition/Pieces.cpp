#include "epafi/decomposition/Pieces.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/EqualMatrices.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace epafi::decomposition {

Sharing::Sharing(const BodyLayout& body, const fem::AssembledSubdomain& piece) {
  nodes_.reserve(piece.borderNodes.size());
  start_.reserve(piece.borderNodes.size() + 1);
  parts_.reserve(3 * piece.borderNodes.size());
  std::vector<GlobalOrdinal> elements;
  for (const int place : piece.borderNodes) {
    const auto node = static_cast<std::size_t>(place);
    body.mesh->nodeElements(piece.nodes[node], elements);
    const auto first = static_cast<std::ptrdiff_t>(parts_.size());
    for (const GlobalOrdinal element : elements) {
      const int part = body.partition->partOf(element);
      if (std::find(parts_.begin() + first, parts_.end(), part) == parts_.end())
        parts_.push_back(part);
    }
    std::sort(parts_.begin() + first, parts_.end());
    nodes_.push_back(node);
    start_.push_back(parts_.size());
  }
}

Sharing::Sharing(std::vector<std::size_t> nodes, const std::vector<std::vector<int>>& parts)
    : nodes_(std::move(nodes)) {
  for (const std::vector<int>& atNode : parts) {
    parts_.insert(parts_.end(), atNode.begin(), atNode.end());
    start_.push_back(parts_.size());
  }
}

std::optional<std::size_t> Sharing::find(std::size_t node) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), node);
  if (found == nodes_.end() || *found != node)
    return std::nullopt;
  return static_cast<std::size_t>(found - nodes_.begin());
}

bool Sharing::isLowest(int part, std::size_t node) const {
  const std::optional<std::size_t> k = find(node);
  return !k || parts(*k).front() == part;
}

Outline outlineOf(const Layout& layout) {
  Outline outline{{}, layout.numSubdomains};
  for (std::size_t b = 0; b < layout.bodies.size(); ++b) {
    const fem::Mesh* mesh = layout.bodies[b].mesh.get();
    outline.bodies.push_back({fem::dimensionOf(mesh->cellType()), layout.models[b]->components(),
                              layout.bodies[b].firstSubdomain, mesh->numNodes(),
                              [mesh](GlobalOrdinal node) { return mesh->point(node); },
                              [mesh](GlobalOrdinal node) { return mesh->isBoundaryNode(node); }});
  }
  return outline;
}

int bodyOf(const Layout& layout, int number) {
  const auto next =
      std::upper_bound(layout.bodies.begin(), layout.bodies.end(), number,
                       [](int wanted, const BodyLayout& body) { return wanted < body.firstSubdomain; });
  return static_cast<int>(next - layout.bodies.begin()) - 1;
}

namespace {

/// What K R may keep of the sum of its terms' magnitudes: far above round-off, far below a mode that is none.
constexpr double kernelTolerance = 1e-6;

/// The modes come from geometry and supports, K from integrals: one proves the other. One product a mode.
/// \throws Error if K R does not vanish.
void requireKernel(const Piece& piece, const std::string& body) {
  const SparseMatrix& k = *piece.stiffness;
  const Eigen::MatrixXd& r = piece.assembled.kernel;
  for (Eigen::Index mode = 0; mode < r.cols(); ++mode)
    for (Eigen::Index j = 0; j < k.cols(); ++j) {
      double sum = 0, magnitude = 0;
      for (SparseMatrix::InnerIterator entry(k, j); entry; ++entry) { // K is symmetric: columns are rows
        const double term = entry.value() * r(entry.row(), mode);
        sum += term;
        magnitude += std::abs(term);
      }
      if (!(std::abs(sum) <= kernelTolerance * magnitude))
        throw Error("body '" + body + "': its stiffness does not vanish on the rigid motion number " +
                    std::to_string(mode) + " that its supports seem to leave free (" + std::to_string(sum) +
                    " beside terms of " + std::to_string(magnitude) +
                    "); this is a fault of Epafi, please report the scene");
    }
}

} // namespace

std::vector<Piece> assemblePieces(const Layout& layout, const Comm& comm) {
  const auto first = [&](GlobalOrdinal rank) {
    return static_cast<int>(rank * layout.numSubdomains / comm.getSize());
  };
  const int begin = first(comm.getRank()), end = first(comm.getRank() + 1);
  std::vector<Piece> pieces;
  pieces.reserve(static_cast<std::size_t>(end - begin));
  std::optional<fem::SubdomainAssembler> assembler;
  EqualMatrices matrices;
  SparseMatrix scratch;
  for (int number = begin; number < end; ++number) {
    Piece& piece = pieces.emplace_back();
    piece.number = number;
    piece.body = bodyOf(layout, number);
    const auto b = static_cast<std::size_t>(piece.body);
    if (pieces.size() == 1 || piece.body != pieces[pieces.size() - 2].body)
      assembler.emplace(*layout.models[b]);
    const BodyLayout& body = layout.bodies[b];
    piece.part = number - body.firstSubdomain;
    piece.assembled.stiffness.swap(scratch); // its memory is used again if the last matrix was a known one
    assembler->assemble(body.partition->elementsOf(piece.part), piece.assembled);
    piece.stiffness = matrices.store(piece.assembled.stiffness);
    scratch.swap(piece.assembled.stiffness);
    if (layout.models[b]->components() > 1) // of a scalar field R = 1, and nothing can go wrong
      requireKernel(piece, body.name);
    piece.sharing = Sharing(body, piece.assembled);
  }
  return pieces;
}

} // namespace epafi::decomposition
