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

namespace epafi::fem {

class BodyModel {
public:
  virtual ~BodyModel() = default;
  [[nodiscard]] virtual const Mesh& mesh() const = 0;
  /// Unknowns a node.
  [[nodiscard]] virtual int components() const = 0;
  /// Rigid modes that the supports leave free: known from the scene, not from round-off.
  [[nodiscard]] virtual int kernelDimension() const = 0;
  /// Value of a rigid mode at a node and component, mode < kernelDimension().
  [[nodiscard]] virtual double kernelValue(GlobalOrdinal node, int component, int mode) const = 0;
  /// Prescribed value of a node's component, or nothing where it is free.
  [[nodiscard]] virtual std::optional<double> prescribed(GlobalOrdinal node, int component) const = 0;
  /// Element stiffness and load; sizes nodesPerElement · components, node by node.
  virtual void element(GlobalOrdinal element, Eigen::MatrixXd& stiffness, Eigen::VectorXd& load) const = 0;
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
  void element(GlobalOrdinal element, Eigen::MatrixXd& stiffness, Eigen::VectorXd& load) const override;

private:
  const scene::Body& body_;
  const RectangleMesh& mesh_;
  Eigen::Matrix4d unitStiffness_; ///< of conductivity 1; all elements have the same shape
};

} // namespace epafi::fem
