#pragma once

/// The physics of a body of any shape (scene::Solid): membrane, plane strain, plane stress or elasticity in space, on any
/// mesh of linear elements.

#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/RigidModes.hpp"
#include "epafi/fem/SolidBody.hpp"
#include "epafi/fem/SolidDomains.hpp"
#include "epafi/fem/SolidLoads.hpp"
#include "epafi/fem/SolidSupports.hpp"
#include "epafi/scene/Solid.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::fem {

class SolidModel final : public BodyModel {
public:
  /// Keeps references to scene and mesh. \throws InputError, with the body's name, if a surface or group that the scene names is not in
  /// the mesh, a region or load meets no element, a point load no node, supports contradict each other or hardly hold the
  /// body, the physics does not go with the mesh's dimension, parts of the body are not joined, or
  /// those of an elastic one in nodes or edges only: a mechanism.
  SolidModel(std::string name, const scene::Solid& solid, const Mesh& mesh);

  [[nodiscard]] const Mesh& mesh() const override { return body_.mesh; }
  [[nodiscard]] int components() const override { return body_.components(); }
  [[nodiscard]] int kernelDimension() const override { return static_cast<int>(freeModes_.cols()); }
  [[nodiscard]] double kernelValue(GlobalOrdinal node, int component, int mode) const override;
  [[nodiscard]] std::optional<RigidMotions> rigidMotions() const override;
  [[nodiscard]] const Eigen::Matrix3d* frame(GlobalOrdinal node) const override {
    return supports_.frame(node);
  }
  [[nodiscard]] bool hasFrames() const override { return supports_.hasFrames(); }
  [[nodiscard]] std::optional<double> prescribed(GlobalOrdinal node, int component) const override {
    return supports_.value(node, component);
  }
  void prescribed(std::span<const GlobalOrdinal> nodes, std::vector<PrescribedValue>& values) const override {
    supports_.values(nodes, values);
  }
  void kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const override;
  void regions(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> regions) const override;
  void stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const override;
  void loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const override;

  /// What an element is made of.
  [[nodiscard]] const scene::Material& materialOf(GlobalOrdinal element) const;

private:
  void findFreeModes();
  void findFramedElements();
  /// Whether a node of the element has a frame.
  [[nodiscard]] bool isFramed(GlobalOrdinal element) const;
  void turnIntoFrames(GlobalOrdinal element, Eigen::MatrixXd& stiffness) const;
  void turnIntoFrames(GlobalOrdinal element, Eigen::Ref<Eigen::VectorXd> load) const;

  SolidBody body_;
  SolidRegions regions_;
  SolidLoads loads_;
  SolidSupports supports_;
  std::vector<GlobalOrdinal> framedElements_; ///< ascending
  RigidModes rigidModes_;
  Eigen::MatrixXd freeModes_; ///< columns: combinations of the rigid modes
};

} // namespace epafi::fem
