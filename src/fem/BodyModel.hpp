#pragma once

/// The physics of one body: element matrices and loads, supports, and the rigid modes that the supports leave
/// free. What comes after `fem` sees only this interface and never knows which physics it is.

#include "epafi/fem/Mesh.hpp"
#include "epafi/fem/RectangleMesh.hpp"
#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace epafi::fem {

/// A value that a support prescribes; position = place among the nodes asked for × components + component.
struct PrescribedValue {
  std::size_t position = 0;
  double value = 0;
};

/// The rigid motions that supports leave free, as motions in space.
struct RigidMotions {
  Point centre{};         ///< of the body
  double size = 1;        ///< half its largest extent
  Eigen::MatrixXd twists; ///< 6 × kernelDimension: displacement of the centre, rotation vector
};

/// A node's unknowns are its displacement's components along the axes of space, or of its frame if it has one. Stiffness,
/// loads, prescribed values and kernel are all in these unknowns.
class BodyModel {
public:
  virtual ~BodyModel() = default;
  [[nodiscard]] virtual const Mesh& mesh() const = 0; ///< that of the body
  /// Unknowns a node.
  [[nodiscard]] virtual int components() const = 0;
  /// Rigid modes that the supports leave free: known from the scene, not from round-off.
  [[nodiscard]] virtual int kernelDimension() const = 0;
  /// Value of a rigid mode at a node and component, mode < kernelDimension().
  [[nodiscard]] virtual double kernelValue(GlobalOrdinal node, int component, int mode) const = 0;
  /// The rigid motions as motions in space; nothing of a scalar field.
  [[nodiscard]] virtual std::optional<RigidMotions> rigidMotions() const { return std::nullopt; }
  /// The node's frame, a rotation whose columns are the axes of its unknowns, or null where these are those of space. In
  /// the plane it turns about z.
  [[nodiscard]] virtual const Eigen::Matrix3d* frame(GlobalOrdinal /*node*/) const { return nullptr; }
  /// Whether any node has one.
  [[nodiscard]] virtual bool hasFrames() const { return false; }
  /// Prescribed value of a node's component, or nothing where it is free.
  [[nodiscard]] virtual std::optional<double> prescribed(GlobalOrdinal node, int component) const = 0;
  /// All prescribed values at some ascending nodes, in any order, a value that two supports give perhaps
  /// twice; `values` is overwritten.
  virtual void prescribed(std::span<const GlobalOrdinal> nodes,
                          std::vector<PrescribedValue>& values) const = 0;

  /// Kind of each element: elements of one kind have the same stiffness, to the last bit.
  virtual void kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const = 0;
  /// Region of the scene that each element lies in: the last one that contains it, counted from 1; 0 outside of all.
  virtual void regions(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> regions) const;
  /// Stiffness of the elements of a kind; size nodesPerElement · components, node by node.
  virtual void stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const = 0;
  /// Loads of elements, one column each; rows as in the stiffness.
  virtual void loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const = 0;

  /// Stiffness and load of one element.
  void element(GlobalOrdinal element, Eigen::MatrixXd& stiffness, Eigen::VectorXd& load) const;
};

/// −∇·(κ∇u) = f on a rectangle with Q1 elements.
class MembraneModel final : public BodyModel {
public:
  /// Keeps references to both. \throws InputError if two supports give a corner different values.
  MembraneModel(const scene::Body& body, const RectangleMesh& mesh);

  [[nodiscard]] const Mesh& mesh() const override { return mesh_; }
  [[nodiscard]] int components() const override { return 1; }
  [[nodiscard]] int kernelDimension() const override { return body_.supports.empty() ? 1 : 0; }
  [[nodiscard]] double kernelValue(GlobalOrdinal /*node*/, int /*component*/, int /*mode*/) const override {
    return 1.0;
  }
  [[nodiscard]] std::optional<double> prescribed(GlobalOrdinal node, int component) const override;
  void prescribed(std::span<const GlobalOrdinal> nodes, std::vector<PrescribedValue>& values) const override;
  void kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const override {
    regions(elements, kinds);
  }
  void regions(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> regions) const override;
  void stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const override;
  void loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const override;

private:
  /// A region of the scene: its columns and rows of elements, ends excluded.
  struct Patch {
    std::array<GlobalOrdinal, 2> columns, rows;
  };
  /// A load of the scene: its share of each column and each row of elements.
  struct Strips {
    double value = 0;
    std::vector<Eigen::Vector2d> alongX, alongY;
  };

  const scene::Body& body_;
  const RectangleMesh& mesh_;
  Eigen::Matrix4d unitStiffness_; ///< of conductivity 1; all elements have the same shape
  std::vector<Patch> patches_;    ///< of each region
  std::vector<Strips> strips_;    ///< of each load
};

} // namespace epafi::fem
