#include "epafi/model/MeshPieces.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/PointToPoint.hpp"
#include "epafi/fem/MeshPart.hpp"

#include <optional>
#include <utility>

namespace epafi::model {
namespace {

/// A rank's piece, as it is sent.
struct Piece {
  std::vector<std::byte> mesh;
  std::vector<int> parts; ///< of the held elements
};

Piece pieceOf(const BodyLayout& whole, const fem::MeshCutter& cutter, Share own) {
  std::vector<GlobalOrdinal> elements;
  for (int part = own.begin; part < own.end; ++part) {
    const std::vector<GlobalOrdinal> more = whole.partition->elementsOf(part);
    elements.insert(elements.end(), more.begin(), more.end());
  }
  const fem::PartArrays arrays = cutter.around(std::move(elements));
  Piece piece{arrays.packed(), {}};
  for (const GlobalOrdinal element : arrays.elements)
    piece.parts.push_back(whole.partition->partOf(element));
  return piece;
}

/// From rank 0 to a rank.
template <class Value>
void send(const Comm& comm, int rank, std::vector<Value>& values) {
  std::map<int, std::vector<Value>> outgoing;
  if (comm.getRank() == 0)
    outgoing.emplace(rank, std::move(values));
  auto received = exchange(comm, outgoing, comm.getRank() == rank ? std::set<int>{0} : std::set<int>{});
  if (comm.getRank() == rank)
    values = std::move(received.at(0));
}

} // namespace

void dealOut(const BodyLayout* whole, const std::function<Share(int rank)>& partsOf, const Comm& comm,
             BodyLayout& piece) {
  std::optional<fem::MeshCutter> cutter;
  Piece own;
  for (int rank = comm.getSize() - 1; rank >= 0; --rank) { // rank 0 keeps the last one
    Piece next;
    collectively(comm, [&] { // none is to wait for what cannot be cut
      if (whole == nullptr)
        return;
      if (!cutter)
        cutter.emplace(*whole->mesh);
      next = pieceOf(*whole, *cutter, partsOf(rank));
    });
    if (rank > 0) {
      send(comm, rank, next.mesh);
      send(comm, rank, next.parts);
    }
    if (comm.getRank() == rank)
      own = std::move(next);
  }
  collectively(comm, [&] {
    fem::PartArrays arrays = fem::PartArrays::unpacked(own.mesh);
    own.mesh = {};
    const Share parts = partsOf(comm.getRank());
    piece.partition = std::make_shared<const HeldPartition>(
        piece.partition->numParts(),
        HeldElements{parts.begin, parts.end, arrays.elements, std::move(own.parts)});
    piece.mesh = std::make_unique<const fem::MeshPart>(std::move(arrays));
  });
}

} // namespace epafi::model
