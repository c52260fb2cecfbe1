#include "epafi/fem/SolidChecks.hpp"

#include <vector>

namespace epafi::fem {

void requireDimension(const SolidBody& body) {
  const int dimension = dimensionOf(body.mesh.cellType());
  const bool isPlane = body.solid.physics != scene::Physics::elasticity3d;
  if (isPlane != (dimension == 2))
    throw body.refusal("its physics is " + toString(body.solid.physics) + ", but its mesh consists of " +
                       toString(body.mesh.cellType()) + "s; choose " +
                       (isPlane ? "elasticity 3-D" : "membrane, plane strain or plane stress"));
}

void requireNoMechanism(const SolidBody& body) {
  if (body.components() == 1 || body.isCongruent())
    return;
  const Mesh& mesh = body.mesh;
  std::vector<char> isReached(static_cast<std::size_t>(mesh.numElements()), 0);
  std::vector<GlobalOrdinal> front{0}, neighbours;
  isReached[0] = 1;
  GlobalOrdinal numReached = 1;
  while (!front.empty()) {
    const GlobalOrdinal element = front.back();
    front.pop_back();
    mesh.elementNeighbours(element, neighbours);
    for (const GlobalOrdinal other : neighbours)
      if (isReached[static_cast<std::size_t>(other)] == 0) {
        isReached[static_cast<std::size_t>(other)] = 1;
        ++numReached;
        front.push_back(other);
      }
  }
  if (numReached < mesh.numElements())
    throw body.refusal(
        "only " + std::to_string(numReached) + " of its " + std::to_string(mesh.numElements()) +
        " elements are joined with each other in whole " +
        (dimensionOf(mesh.cellType()) == 2 ? "edges" : "faces") +
        "; the others hang on nodes, or on nothing, and could turn: a mechanism. Make each part a body "
        "of its own, or join the parts in the mesh");
}

} // namespace epafi::fem
