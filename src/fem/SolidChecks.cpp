#include "epafi/fem/SolidChecks.hpp"

#include <vector>

namespace epafi::fem {
namespace {

/// Elements that share a node with this one.
void neighboursInNodes(const Mesh& mesh, GlobalOrdinal element, std::vector<GlobalOrdinal>& neighbours) {
  std::vector<GlobalOrdinal> around;
  neighbours.clear();
  for (const GlobalOrdinal node : ElementNodes(mesh, element)) {
    mesh.nodeElements(node, around);
    neighbours.insert(neighbours.end(), around.begin(), around.end());
  }
}

/// Number of the elements that the first one reaches over facets, or over nodes.
GlobalOrdinal numReached(const Mesh& mesh, bool overNodes) {
  std::vector<char> isReached(static_cast<std::size_t>(mesh.numElements()), 0);
  std::vector<GlobalOrdinal> front{0}, neighbours;
  isReached[0] = 1;
  GlobalOrdinal count = 1;
  while (!front.empty()) {
    const GlobalOrdinal element = front.back();
    front.pop_back();
    if (overNodes)
      neighboursInNodes(mesh, element, neighbours);
    else
      mesh.elementNeighbours(element, neighbours);
    for (const GlobalOrdinal other : neighbours)
      if (isReached[static_cast<std::size_t>(other)] == 0) {
        isReached[static_cast<std::size_t>(other)] = 1;
        ++count;
        front.push_back(other);
      }
  }
  return count;
}

} // namespace

void requireDimension(const SolidBody& body) {
  const bool isPlane = dimensionOf(body.body.physics) == 2;
  if (isPlane != (dimensionOf(body.mesh.cellType()) == 2))
    throw body.refusal("its physics is " + toString(body.body.physics) + ", but its mesh consists of " +
                       toString(body.mesh.cellType()) + "s; choose " +
                       (isPlane ? "elasticity 3-D" : "membrane, plane strain or plane stress"));
}

void requireJoined(const SolidBody& body) {
  if (body.isCongruent())
    return;
  const Mesh& mesh = body.mesh;
  const bool isMembrane = body.components() == 1;
  const GlobalOrdinal numJoined = numReached(mesh, isMembrane);
  if (numJoined == mesh.numElements())
    return;
  const std::string counts = "only " + std::to_string(numJoined) + " of its " +
                             std::to_string(mesh.numElements()) + " elements are joined with each other";
  if (isMembrane)
    throw body.refusal(counts + "; make each part a body of its own, or join the parts in the mesh");
  throw body.refusal(counts + " in whole " + (dimensionOf(mesh.cellType()) == 2 ? "edges" : "faces") +
                     "; the others hang on nodes, or on nothing, and could turn: a mechanism. Make each part "
                     "a body of its own, or join the parts in the mesh");
}

} // namespace epafi::fem
