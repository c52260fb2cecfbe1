#pragma once

/// What the supports of a body hold: components of nodes, in the axes of space or in a frame of the node's
/// own.

#include "epafi/decomposition/RigidModes.hpp"
#include "epafi/fem/SolidBody.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace epafi::fem {

/// A value that a support prescribes; position = place among the nodes asked for × components + component.
struct PrescribedValue {
  std::size_t position = 0;
  double value = 0;
  int support = -1; ///< which of the solid's; −1: the axis of revolution
};

class SolidSupports {
public:
  /// Nodes on the axis of a solid of revolution are held across it, whatever supports say, if it holds them.
  /// \throws InputError if a surface is not there, a membrane is to slide, or supports contradict each other.
  explicit SolidSupports(const SolidBody& body);

  /// Prescribed value of a component in the node's frame.
  [[nodiscard]] std::optional<double> value(GlobalOrdinal node, int component) const;
  /// See BodyModel::prescribed.
  void values(std::span<const GlobalOrdinal> nodes, std::vector<PrescribedValue>& values) const;

  /// The frame of a node, or null where it is the axes of space: a rotation whose columns are the axes of its
  /// unknowns.
  [[nodiscard]] const Eigen::Matrix3d* frame(GlobalOrdinal node) const;
  /// Nodes with frames, ascending.
  [[nodiscard]] std::vector<GlobalOrdinal> framedNodes() const;
  [[nodiscard]] bool hasFrames() const { return !frames_.empty(); }

  /// All that is held, as directions at points.
  [[nodiscard]] std::vector<decomposition::HeldDirection> directions(const mesh::Mesh& mesh) const;

private:
  struct Held {
    GlobalOrdinal node;
    int component;
    double value;
    int support;
  };
  /// directionᵀu = value at a node, as a support says.
  struct Condition {
    GlobalOrdinal node;
    Eigen::Vector3d direction;
    double value;
    int component; ///< −1: along a normal or an axis of its own
    const SolidSupport* support;
  };

  [[nodiscard]] static std::vector<Condition> conditionsOf(const SolidBody& body);
  void hold(const SolidBody& body, std::span<const Condition> conditions);
  /// \param supports  which hold the axes
  void holdInFrame(GlobalOrdinal node, int components, std::span<const Eigen::Vector3d> axes,
                   std::span<const double> values, std::span<const int> supports);

  int components_;
  std::vector<Held> held_;                                        ///< ascending by node and component
  std::vector<std::pair<GlobalOrdinal, Eigen::Matrix3d>> frames_; ///< ascending by node
};

} // namespace epafi::fem
