#include "epafi/contact/SurfaceContact.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/contact/RigidLinks.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <utility>

namespace epafi::contact {
namespace {

/// The rows as a matrix, dealt out to the ranks by their nodes.
CoupledSurfaces asMatrix(const ContactTerms& terms, ContactLayout layout, const RCP<const Comm>& comm) {
  layout.firstBody = layout.secondBody = 0; // nodes are numbered through all bodies
  std::vector<GlobalOrdinal> nodes = layout.firstNodes;
  sortUnique(nodes);
  NodeUnknowns unknowns;
  unknowns.components = terms.components;
  unknowns.firstNode = {0};
  unknowns.frame = [](int, GlobalOrdinal) { return nullptr; };
  unknowns.isHeld = [](int, GlobalOrdinal, int) { return false; };
  unknowns.isMine = [&](int, GlobalOrdinal node) {
    const std::size_t place = std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin();
    return place * comm->getSize() / nodes.size() == static_cast<std::size_t>(comm->getRank());
  };
  decomposition::ConstraintMatrix matrix = contactMatrix({layout}, unknowns, comm);
  return {std::move(matrix), std::move(layout)};
}

} // namespace

CoupledSurfaces contactBetween(const ContactTerms& terms, const PlacedSurface& first,
                               const PlacedSurface& second, const RCP<const Comm>& comm) {
  ContactLayout layout;
  collectively(*comm, [&] { layout = meetByMortar(terms, first, second); });
  return asMatrix(terms, std::move(layout), comm);
}

CoupledSurfaces tieBetween(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second,
                           const RCP<const Comm>& comm, const HeldNodes& isHeld) {
  ContactLayout layout;
  collectively(*comm, [&] {
    layout = tieByMortar(terms, first, second, isHeld);
    linkRigidly(first, second, layout);
  });
  return asMatrix(terms, std::move(layout), comm);
}

} // namespace epafi::contact
