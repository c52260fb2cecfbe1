#include "epafi/fem/SolidSupports.hpp"

#include "epafi/base/Text.hpp"
#include "epafi/fem/SupportNormals.hpp"
#include "epafi/mesh/MeshPart.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::fem {
namespace {

using Eigen::Vector3d;

/// A direction that others hold up to this angle adds nothing to them; it must agree with them as well.
constexpr double sameDirection = 1e-6;
/// Axes of a frame that are nearer to those of space than this are these.
constexpr double onAxis = 1e-12;

/// The axis of space that a direction of length 1 is, up to its sign, or −1.
int axisOf(const Vector3d& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return (direction.cwiseAbs() - Vector3d::Unit(axis)).norm() <= onAxis ? static_cast<int>(axis) : -1;
}

/// What is known of directionᵀu, up to a share of the values.
struct Known {
  double value, uncertainty;
};

/// Of a solid of revolution, as far as they are held here.
std::vector<GlobalOrdinal> nodesOnAxis(const SolidBody& body) {
  const mesh::MeshPart* const part = body.mesh.part();
  const double tolerance = body.axisTolerance();
  const auto numHeld =
      part != nullptr ? static_cast<GlobalOrdinal>(part->nodes().size()) : body.mesh.numNodes();
  std::vector<GlobalOrdinal> nodes;
  for (GlobalOrdinal held = 0; held < numHeld; ++held)
    if (const GlobalOrdinal node = part != nullptr ? part->nodes()[held] : held;
        std::abs(body.mesh.point(node)[0]) <= tolerance)
      nodes.push_back(node);
  return nodes;
}

/// Axes held at a node, orthonormal, and how far it is moved along them.
class HeldAxes {
public:
  /// Takes directionᵀu = value in; returns what the axes before say of directionᵀu where they hold it
  /// already.
  std::optional<Known> add(const Vector3d& direction, double value, int support) {
    Vector3d rest = direction;
    double known = 0;
    for (std::size_t k = 0; k < axes_.size(); ++k) {
      const double share = axes_[k].dot(direction);
      rest -= share * axes_[k];
      known += share * values_[k];
    }
    const double length = rest.norm();
    if (length <= sameDirection)
      return Known{known, 2 * length + 1e-12};
    axes_.emplace_back(rest / length);
    values_.push_back((value - known) / length);
    supports_.push_back(support);
    return std::nullopt;
  }
  [[nodiscard]] std::span<const Vector3d> axes() const { return axes_; }
  [[nodiscard]] std::span<const double> values() const { return values_; }
  [[nodiscard]] std::span<const int> supports() const { return supports_; }

private:
  std::vector<Vector3d> axes_;
  std::vector<double> values_;
  std::vector<int> supports_;
};

/// Its place, or −1 if it is none of these.
int numberOf(const SolidSupport& support, const std::vector<SolidSupport>& supports) {
  const auto found = std::find_if(supports.begin(), supports.end(),
                                  [&](const SolidSupport& one) { return &one == &support; });
  return found == supports.end() ? -1 : static_cast<int>(found - supports.begin());
}

} // namespace

SolidSupports::SolidSupports(const SolidBody& body) : components_(body.components()) {
  const std::vector<Condition> conditions = conditionsOf(body);
  for (auto first = conditions.begin(); first != conditions.end();) {
    const auto next = std::find_if(first, conditions.end(),
                                   [&](const Condition& condition) { return condition.node != first->node; });
    hold(body, {first, next});
    first = next;
  }
}

/// By ascending node; at each first the components, so that frames arise only where normals add something.
std::vector<SolidSupports::Condition> SolidSupports::conditionsOf(const SolidBody& body) {
  std::vector<Condition> conditions;
  for (const SolidSupport& support : body.solid.supports) {
    const std::string user = "support '" + support.name + "'";
    const auto valueAt = [&](GlobalOrdinal node, const Vector3d& direction, double value) {
      return support.displacements ? direction.dot(Vector3d(support.displacements->at(node).data())) : value;
    };
    for (const GlobalOrdinal node : body.nodesOf(user, support.surface)) {
      const Eigen::Matrix3d axes = support.axes ? axesAt(*support.axes, body.mesh.point(node))
                                                : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
      for (int c = 0; c < body.components(); ++c)
        if (const auto& value = support.value[c])
          conditions.push_back(
              {node, axes.col(c), valueAt(node, axes.col(c), *value), support.axes ? -1 : c, &support});
    }
    if (!support.normal)
      continue;
    if (body.components() == 1)
      throw body.refusal("support '" + support.name +
                         "' holds the displacement along the normal, which a membrane does not have; give "
                         "its value instead");
    for (const NodeNormal& at : supportNormals(body.mesh, body.surfaceOf(user, support.surface)))
      conditions.push_back({at.node, at.normal, valueAt(at.node, at.normal, *support.normal), -1, &support});
  }
  if (body.solid.physics == Physics::axisymmetric && body.solid.holdsAxis) {
    static const SolidSupport axis{"axis of revolution", "", {}};
    for (const GlobalOrdinal node : nodesOnAxis(body))
      conditions.push_back({node, Vector3d::UnitX(), 0, 0, &axis});
  }
  std::stable_sort(conditions.begin(), conditions.end(), [](const Condition& a, const Condition& b) {
    return a.node != b.node ? a.node < b.node : a.component >= 0 && b.component < 0;
  });
  return conditions;
}

/// All conditions at one node.
void SolidSupports::hold(const SolidBody& body, std::span<const Condition> conditions) {
  HeldAxes held;
  for (const Condition& condition : conditions) {
    const std::optional<Known> known =
        held.add(condition.direction, condition.value, numberOf(*condition.support, body.solid.supports));
    if (!known)
      continue;
    double scale = std::abs(condition.value);
    for (const double value : held.values())
      scale = std::max(scale, std::abs(value));
    if (std::abs(known->value - condition.value) > known->uncertainty * scale)
      throw body.refusal(
          "supports '" + conditions.front().support->name + "' and '" + condition.support->name +
          "' hold the node at " + text(body.mesh.point(condition.node)) +
          (condition.component >= 0 ? std::string(" in component ") + "xyz"[condition.component]
                                    : " along " + text(condition.direction) +
                                          (condition.support->axes ? "" : ", the normal of the surface,")) +
          " at different values, " + text(known->value) + " and " + text(condition.value));
  }
  holdInFrame(conditions.front().node, body.components(), held.axes(), held.values(), held.supports());
}

/// Where the axes are those of space, or hold the node altogether, its unknowns stay the components in space,
/// each held by the support whose axis is nearest to it.
void SolidSupports::holdInFrame(GlobalOrdinal node, int components, std::span<const Vector3d> axes,
                                std::span<const double> values, std::span<const int> supports) {
  const bool isAlong =
      std::all_of(axes.begin(), axes.end(), [](const Vector3d& axis) { return axisOf(axis) >= 0; });
  if (isAlong || std::ssize(axes) == components) {
    Vector3d value(0, 0, 0);
    for (std::size_t k = 0; k < axes.size(); ++k)
      value += values[k] * axes[k];
    for (int c = 0; c < components; ++c) {
      const auto nearest =
          std::max_element(axes.begin(), axes.end(), [c](const Vector3d& a, const Vector3d& b) {
            return std::abs(a[c]) < std::abs(b[c]);
          });
      if (!isAlong || axisOf(*nearest) == c)
        held_.push_back({node, c, value[c], supports[nearest - axes.begin()]});
    }
    return;
  }
  Eigen::Matrix3d frame;
  int numAxes = 0;
  for (const Vector3d& axis : axes) {
    held_.push_back({node, numAxes, values[numAxes], supports[numAxes]});
    frame.col(numAxes++) = axis;
  }
  while (numAxes < 3) { // the axis of space that is farthest from those so far, z last in the plane
    Vector3d best(0, 0, 0);
    for (int c = 0; c < (numAxes < components ? components : 3); ++c) {
      Vector3d rest = Vector3d::Unit(c);
      for (int k = 0; k < numAxes; ++k)
        rest -= frame.col(k).dot(rest) * frame.col(k);
      if (rest.norm() > best.norm() * (1 + 1e-9))
        best = rest;
    }
    frame.col(numAxes++) = best.normalized();
  }
  frames_.emplace_back(node, frame);
}

std::optional<double> SolidSupports::value(GlobalOrdinal node, int component) const {
  const auto found = std::lower_bound(held_.begin(), held_.end(), std::pair(node, component),
                                      [](const Held& held, const std::pair<GlobalOrdinal, int>& wanted) {
                                        return std::pair(held.node, held.component) < wanted;
                                      });
  if (found == held_.end() || found->node != node || found->component != component)
    return std::nullopt;
  return found->value;
}

void SolidSupports::values(std::span<const GlobalOrdinal> nodes, std::vector<PrescribedValue>& values) const {
  values.clear();
  if (nodes.empty())
    return;
  auto held = std::lower_bound(held_.begin(), held_.end(), nodes.front(),
                               [](const Held& h, GlobalOrdinal node) { return h.node < node; });
  for (auto node = nodes.begin(); held != held_.end() && held->node <= nodes.back(); ++held) {
    node = std::lower_bound(node, nodes.end(), held->node);
    if (node != nodes.end() && *node == held->node)
      values.push_back(
          {static_cast<std::size_t>(node - nodes.begin()) * static_cast<std::size_t>(components_) +
               static_cast<std::size_t>(held->component),
           held->value, held->support});
  }
}

const Eigen::Matrix3d* SolidSupports::frame(GlobalOrdinal node) const {
  const auto found = std::lower_bound(frames_.begin(), frames_.end(), node,
                                      [](const auto& entry, GlobalOrdinal n) { return entry.first < n; });
  return found == frames_.end() || found->first != node ? nullptr : &found->second;
}

std::vector<GlobalOrdinal> SolidSupports::framedNodes() const {
  std::vector<GlobalOrdinal> nodes;
  for (const auto& [node, frame] : frames_)
    nodes.push_back(node);
  return nodes;
}

std::vector<decomposition::HeldDirection> SolidSupports::directions(const mesh::Mesh& mesh) const {
  std::vector<decomposition::HeldDirection> directions;
  for (const Held& held : held_) {
    const Eigen::Matrix3d* own = frame(held.node);
    directions.push_back({mesh.point(held.node), own != nullptr ? Vector3d(own->col(held.component))
                                                                : Vector3d(Vector3d::Unit(held.component))});
  }
  return directions;
}

} // namespace epafi::fem
