#include "epafi/fem/BodyModel.hpp"

#include "epafi/base/SortUnique.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/mesh/ConnectedElements.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/MeshPart.hpp"

#include <algorithm>
#include <utility>

namespace epafi::fem {
namespace {

using decomposition::FreeModes;
using decomposition::RigidModes;

/// \throws InputError if a plane physics meets a mesh in space, or the other way round.
void requireDimension(const SolidBody& body) {
  const bool isPlane = dimensionOf(body.solid.physics) == 2;
  if (isPlane != (dimensionOf(body.mesh.cellType()) == 2))
    throw body.refusal("its physics is " + toString(body.solid.physics) + ", but its mesh consists of " +
                       toString(body.mesh.cellType()) + "s; choose " +
                       (isPlane ? "elasticity 3-D" : "membrane, plane strain, plane stress or axisymmetric"));
}

/// x is the radius of solids of revolution. \throws InputError if it is negative somewhere
void requireRadii(const SolidBody& body) {
  if (body.solid.physics != Physics::axisymmetric)
    return;
  const double least = body.box()[0][0];
  if (least < -body.axisTolerance())
    throw body.refusal("it is axisymmetric, so that x is the distance from its axis, but it reaches to x = " +
                       text(least) + "; mesh the half of its section with x >= 0 alone");
}

/// Elements joined in facets move as one rigid body; those joined in less may turn about each other, which
/// membranes cannot. \throws InputError if an elastic body is not joined in facets, or a membrane not even in
/// nodes. Linear in the number of elements.
void requireJoined(const SolidBody& body) {
  if (body.isCongruent() || body.mesh.part() != nullptr) // whoever dealt out the pieces has looked
    return;
  const mesh::Mesh& mesh = body.mesh;
  const bool isMembrane = body.components() == 1;
  std::vector<GlobalOrdinal> around;
  const auto pieces = mesh::connectedElements(mesh.numElements(), [&](GlobalOrdinal element, auto& found) {
    if (!isMembrane)
      return mesh.elementNeighbours(element, found);
    found.clear();
    for (const GlobalOrdinal node : mesh::ElementNodes(mesh, element)) {
      mesh.nodeElements(node, around);
      found.insert(found.end(), around.begin(), around.end());
    }
  });
  if (pieces.size() == 1)
    return;
  const std::string counts = "only " + std::to_string(pieces.front().size()) + " of its " +
                             std::to_string(mesh.numElements()) + " elements are joined with each other";
  if (isMembrane)
    throw body.refusal(counts + "; make each part a body of its own, or join the parts in the mesh");
  throw body.refusal(counts + " in whole " + (dimensionOf(mesh.cellType()) == 2 ? "edges" : "faces") +
                     "; the others hang on nodes, or on nothing" +
                     (body.solid.physics == Physics::axisymmetric ? "" : ", and could turn: a mechanism") +
                     ". Make each part a body of its own, or join the parts in the mesh");
}

/// Of other elements motions without energy would go on from element to element.
void requireIntegration(const SolidBody& body) {
  if (!body.solid.reducedIntegration)
    return;
  bool hasRule = body.mesh.part() != nullptr; // whoever dealt out the pieces has looked
  for (GlobalOrdinal element = 0; !hasRule && element < body.mesh.numElements(); ++element)
    hasRule = hasReducedRule(mesh::ElementNodes(body.mesh, element).type());
  if (!hasRule)
    throw body.refusal(
        "reduced integration goes with quadrilaterals of 8 nodes, hexahedra of 20 and prisms, but its "
        "mesh consists of " +
        std::string(toString(body.mesh.cellType())) +
        "s; choose the integration \"full\", or the \"Inner Nodes\" \"none\" if its mesh file has such "
        "elements");
  if (body.components() == 1)
    throw body.refusal("membranes are integrated fully; choose the integration \"full\"");
}

SolidBody checked(SolidBody body) {
  requireDimension(body);
  requireRadii(body);
  requireIntegration(body);
  requireJoined(body);
  return body;
}

/// ∫∇N_i·∇N_j over a rectangle of sides hx, hy in closed form: entries that symmetry makes equal are so to
/// the last bit, which sums over Gauss points are not.
Eigen::Matrix4d rectangleStiffness(double hx, double hy) {
  const double a = hy / (6 * hx), b = hx / (6 * hy);
  const double self = 2 * a + 2 * b, alongX = -2 * a + b, opposite = -a - b, alongY = a - 2 * b;
  Eigen::Matrix4d k;
  k << self, alongX, opposite, alongY, //
      alongX, self, alongY, opposite,  //
      opposite, alongY, self, alongX,  //
      alongY, opposite, alongX, self;
  return k;
}

/// About the middle of the body's bounding box.
RigidModes rigidModesOf(const SolidBody& body) {
  const auto [lower, upper] = body.box();
  Point centre{};
  double size = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    centre[d] = 0.5 * (lower[d] + upper[d]);
    size = std::max(size, upper[d] - lower[d]);
  }
  return {body.components(), centre, 0.5 * size, body.solid.physics == Physics::axisymmetric};
}

} // namespace

BodyModel::BodyModel(const Solid& body, const mesh::Mesh& mesh)
    : body_(checked({body, mesh})), unknowns_(mesh, body_.components()), regions_(body_), factors_(body_),
      loads_(body_, regions_), supports_(body_), rigidModes_(rigidModesOf(body_)) {
  integrateRegions();
  findFramedElements();
  findFreeModes();
}

void BodyModel::integrateRegions() {
  for (std::size_t region = 0; body_.isCongruent() && region < regions_.number(); ++region) {
    const Material& material = materialIn(body_.solid, region);
    Eigen::MatrixXd& stiffness = stiffnesses_.emplace_back();
    if (body_.mesh.cellType() == mesh::CellType::quadrilateral && components() == 1)
      stiffness = material.conductivity * rectangleStiffness(body_.mesh.structured()->elementSize()[0],
                                                             body_.mesh.structured()->elementSize()[1]);
    else
      elementStiffness(body_.mesh.cellType(), body_.shape, body_.solid.physics, material, stiffness,
                       integrationOf(body_.solid));
  }
}

void BodyModel::findFreeModes() {
  FreeModes free = rigidModes_.freeOf(supports_.directions(body_.mesh));
  if (free.leastHold < RigidModes::heldFrom) {
    throw body_.refusal("its supports hardly hold it: a rigid motion moves the supported points by only " +
                        text(free.leastHold) +
                        " of itself, too little to tell from round-off; support points that lie farther "
                        "apart or less in one line, or leave the motion wholly free");
  }
  freeModes_ = std::move(free.modes);
}

void BodyModel::findFramedElements() {
  std::vector<GlobalOrdinal> elements;
  for (const GlobalOrdinal node : supports_.framedNodes()) {
    body_.mesh.nodeElements(node, elements);
    framedElements_.insert(framedElements_.end(), elements.begin(), elements.end());
  }
  sortUnique(framedElements_);
}

bool BodyModel::isFramed(GlobalOrdinal element) const {
  return std::binary_search(framedElements_.begin(), framedElements_.end(), element);
}

double BodyModel::kernelValue(GlobalOrdinal node, int component, int mode) const {
  if (components() == 1)
    return freeModes_(0, mode);
  const Point point = body_.mesh.point(node);
  const Eigen::Matrix3d* own = supports_.hasFrames() ? frame(node) : nullptr;
  return freeModes_.col(mode).dot(own != nullptr ? rigidModes_.along(point, own->col(component))
                                                 : rigidModes_.at(point, component));
}

std::optional<decomposition::RigidMotions> BodyModel::rigidMotions() const {
  if (components() == 1)
    return std::nullopt;
  const Point& centre = rigidModes_.centre();
  return decomposition::RigidMotions{
      {centre[0], centre[1], centre[2]}, rigidModes_.size(), rigidModes_.twists() * freeModes_};
}

/// Where elements are congruent the kind is the region, and behind the regions come those that turn into
/// frames; else the kind is the element.
void BodyModel::kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const {
  if (!body_.isCongruent()) {
    std::copy(elements.begin(), elements.end(), kinds.begin());
    return;
  }
  regions_.of(body_, elements, kinds);
  for (std::size_t e = 0; !framedElements_.empty() && e < elements.size(); ++e)
    if (isFramed(elements[e]))
      kinds[e] = regions_.number() + elements[e];
}

void BodyModel::stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const {
  const GlobalOrdinal numShared = stiffnesses_.size();
  if (kind < numShared) {
    stiffness = stiffnesses_[kind];
    return;
  }
  const GlobalOrdinal element = kind - numShared;
  std::vector<Point> points;
  std::vector<double> factors;
  body_.cornersOf(element, points);
  stiffnessFactors(element, factors);
  elementStiffness(cellOf(body_.mesh.cellType(), points.size()), points, body_.solid.physics,
                   materialOf(element), stiffness, integrationOf(body_.solid), factors);
  if (isFramed(element))
    turnIntoFrames(element, stiffness);
}

void BodyModel::element(GlobalOrdinal element, Eigen::MatrixXd& stiffness, Eigen::VectorXd& load) const {
  GlobalOrdinal kind = 0;
  Eigen::MatrixXd column;
  kinds(std::span(&element, 1), std::span(&kind, 1));
  this->stiffness(kind, stiffness);
  loads(std::span(&element, 1), column);
  load = column.col(0).head(stiffness.rows());
}

void BodyModel::loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  loads_.of(body_, regions_, factors_, elements, loads);
  if (!supports_.hasFrames())
    return;
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (isFramed(elements[e]))
      turnIntoFrames(elements[e], loads.col(e));
}

/// QᵀKQ, Q of the element's nodes.
void BodyModel::turnIntoFrames(GlobalOrdinal element, Eigen::MatrixXd& stiffness) const {
  const mesh::ElementNodes nodes(body_.mesh, element);
  const int n = components();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (const Eigen::Matrix3d* own = frame(nodes[i])) {
      const Eigen::MatrixXd q = own->topLeftCorner(n, n);
      const Eigen::Index first = n * i;
      stiffness.middleCols(first, n) = (stiffness.middleCols(first, n) * q).eval();
      stiffness.middleRows(first, n) = (q.transpose() * stiffness.middleRows(first, n)).eval();
    }
  stiffness = (0.5 * (stiffness + stiffness.transpose())).eval(); // symmetric to the last digit
}

/// Qᵀf.
void BodyModel::turnIntoFrames(GlobalOrdinal element, Eigen::Ref<Eigen::VectorXd> load) const {
  const mesh::ElementNodes nodes(body_.mesh, element);
  const int n = components();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (const Eigen::Matrix3d* own = frame(nodes[i])) {
      auto part = load.segment(n * i, n);
      part = (own->topLeftCorner(n, n).transpose() * part).eval();
    }
}

} // namespace epafi::fem
