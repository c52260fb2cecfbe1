#include "epafi/fem/SolidModel.hpp"

#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/SolidChecks.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

namespace epafi::fem {
namespace {

SolidBody checked(SolidBody body) {
  requireDimension(body);
  requireJoined(body);
  return body;
}

/// About the middle of the body's bounding box.
RigidModes rigidModesOf(const SolidBody& body) {
  const Mesh& mesh = body.mesh;
  Point lower = mesh.point(0), upper = lower, centre{};
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); node += body.isCongruent() ? mesh.numNodes() - 1 : 1) {
    const Point point = mesh.point(node); // of a structured mesh the first and the last will do
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] = std::min(lower[d], point[d]);
      upper[d] = std::max(upper[d], point[d]);
    }
  }
  double size = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    centre[d] = 0.5 * (lower[d] + upper[d]);
    size = std::max(size, upper[d] - lower[d]);
  }
  return {body.components(), centre, 0.5 * size};
}

} // namespace

SolidModel::SolidModel(std::string name, const scene::Solid& solid, const Mesh& mesh)
    : body_(checked({std::move(name), solid, mesh})), regions_(body_), loads_(body_, regions_),
      supports_(body_), rigidModes_(rigidModesOf(body_)) {
  findFramedElements();
  findFreeModes();
}

void SolidModel::findFreeModes() {
  FreeModes free = rigidModes_.freeOf(supports_.directions(body_.mesh));
  if (free.leastHold < RigidModes::heldFrom) {
    std::ostringstream hold;
    hold << free.leastHold;
    throw body_.refusal("its supports hardly hold it: a rigid motion moves the supported points by only " +
                        hold.str() +
                        " of itself, too little to tell from round-off; support points that lie farther "
                        "apart or less in one line, or leave the motion wholly free");
  }
  freeModes_ = std::move(free.modes);
}

void SolidModel::findFramedElements() {
  std::vector<GlobalOrdinal> elements;
  for (const GlobalOrdinal node : supports_.framedNodes()) {
    body_.mesh.nodeElements(node, elements);
    framedElements_.insert(framedElements_.end(), elements.begin(), elements.end());
  }
  std::sort(framedElements_.begin(), framedElements_.end());
  framedElements_.erase(std::unique(framedElements_.begin(), framedElements_.end()), framedElements_.end());
}

bool SolidModel::isFramed(GlobalOrdinal element) const {
  return std::binary_search(framedElements_.begin(), framedElements_.end(), element);
}

double SolidModel::kernelValue(GlobalOrdinal node, int component, int mode) const {
  const Point point = body_.mesh.point(node);
  const Eigen::Matrix3d* own = supports_.hasFrames() ? frame(node) : nullptr;
  return freeModes_.col(mode).dot(own != nullptr ? rigidModes_.along(point, own->col(component))
                                                 : rigidModes_.at(point, component));
}

std::optional<RigidMotions> SolidModel::rigidMotions() const {
  if (components() == 1)
    return std::nullopt;
  return RigidMotions{rigidModes_.centre(), rigidModes_.size(), rigidModes_.twists() * freeModes_};
}

const scene::Material& SolidModel::materialOf(GlobalOrdinal element) const {
  return materialIn(body_.solid, regions_.regionOf(body_, element));
}

/// Where elements are congruent the kind is the region, and behind the regions come those that turn into frames; else
/// the kind is the element.
void SolidModel::kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const {
  const auto numRegions = static_cast<GlobalOrdinal>(regions_.number());
  for (std::size_t e = 0; e < elements.size(); ++e)
    kinds[e] = !body_.isCongruent()    ? elements[e]
               : isFramed(elements[e]) ? numRegions + elements[e]
                                       : static_cast<GlobalOrdinal>(regions_.regionOf(body_, elements[e]));
}

void SolidModel::regions(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> regions) const {
  for (std::size_t e = 0; e < elements.size(); ++e)
    regions[e] = static_cast<GlobalOrdinal>(regions_.regionOf(body_, elements[e]));
}

void SolidModel::stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const {
  const auto numRegions = static_cast<GlobalOrdinal>(regions_.number());
  const scene::Physics physics = body_.solid.physics;
  const CellType type = body_.mesh.cellType();
  if (body_.isCongruent() && kind < numRegions) {
    elementStiffness(type, body_.shape, physics, materialIn(body_.solid, static_cast<std::size_t>(kind)),
                     stiffness);
    return;
  }
  const GlobalOrdinal element = body_.isCongruent() ? kind - numRegions : kind;
  std::vector<Point> points;
  body_.cornersOf(element, points);
  elementStiffness(type, points, physics, materialOf(element), stiffness);
  if (isFramed(element))
    turnIntoFrames(element, stiffness);
}

void SolidModel::loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  loads_.of(body_, regions_, elements, loads);
  if (!supports_.hasFrames())
    return;
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (isFramed(elements[e]))
      turnIntoFrames(elements[e], loads.col(static_cast<Eigen::Index>(e)));
}

/// QᵀKQ, Q of the element's nodes.
void SolidModel::turnIntoFrames(GlobalOrdinal element, Eigen::MatrixXd& stiffness) const {
  std::array<GlobalOrdinal, 8> nodes{};
  const int number = body_.mesh.nodesPerElement(), n = components();
  body_.mesh.elementNodes(element, std::span(nodes).first(static_cast<std::size_t>(number)));
  for (int i = 0; i < number; ++i)
    if (const Eigen::Matrix3d* own = frame(nodes[static_cast<std::size_t>(i)])) {
      const Eigen::MatrixXd q = own->topLeftCorner(n, n);
      stiffness.middleCols(n * i, n) = (stiffness.middleCols(n * i, n) * q).eval();
      stiffness.middleRows(n * i, n) = (q.transpose() * stiffness.middleRows(n * i, n)).eval();
    }
  stiffness = (0.5 * (stiffness + stiffness.transpose())).eval(); // symmetric to the last digit
}

/// Qᵀf.
void SolidModel::turnIntoFrames(GlobalOrdinal element, Eigen::Ref<Eigen::VectorXd> load) const {
  std::array<GlobalOrdinal, 8> nodes{};
  const int number = body_.mesh.nodesPerElement(), n = components();
  body_.mesh.elementNodes(element, std::span(nodes).first(static_cast<std::size_t>(number)));
  for (int i = 0; i < number; ++i)
    if (const Eigen::Matrix3d* own = frame(nodes[static_cast<std::size_t>(i)]))
      load.segment(n * i, n) = (own->topLeftCorner(n, n).transpose() * load.segment(n * i, n)).eval();
}

} // namespace epafi::fem
