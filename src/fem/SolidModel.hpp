#pragma once

/// The physics of a body of any shape (scene::Solid): membrane, plane strain, plane stress or elasticity in space, on any
/// mesh of linear elements.

#include "epafi/base/Errors.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/RigidModes.hpp"
#include "epafi/scene/Solid.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::fem {

class SolidModel final : public BodyModel {
public:
  /// Keeps references to scene and mesh. \throws InputError, with the body's name, if a surface or group that the scene names is not in
  /// the mesh, a region or load meets no element, a point load no node, supports contradict each other, the physics does
  /// not go with the mesh's dimension, or parts of an elastic body are joined in nodes or edges only: a mechanism.
  SolidModel(std::string name, const scene::Solid& solid, const Mesh& mesh);

  [[nodiscard]] const Mesh& mesh() const override { return mesh_; }
  [[nodiscard]] int components() const override { return components_; }
  [[nodiscard]] int kernelDimension() const override { return static_cast<int>(freeModes_.cols()); }
  [[nodiscard]] double kernelValue(GlobalOrdinal node, int component, int mode) const override {
    return freeModes_.col(mode).dot(rigidModes_.at(mesh_.point(node), component));
  }
  [[nodiscard]] std::optional<double> prescribed(GlobalOrdinal node, int component) const override;
  void prescribed(std::span<const GlobalOrdinal> nodes, std::vector<PrescribedValue>& values) const override;
  void kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const override;
  void stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const override;
  void loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const override;

  /// What an element is made of.
  [[nodiscard]] const scene::Material& materialOf(GlobalOrdinal element) const;

private:
  struct Held {
    GlobalOrdinal node;
    int component;
    double value;
  };
  /// A force at a node, carried by one of its elements.
  struct NodalForce {
    GlobalOrdinal element, node;
    scene::Vector3 force;
  };
  /// Part of the body: elements of a group, or whose centre lies in a box.
  struct Domain {
    bool isGroup = false;
    std::vector<GlobalOrdinal> elements; ///< of the group, ascending
    scene::Box box;
  };

  [[nodiscard]] InputError refusal(const std::string& what) const;
  void requireDimension() const;
  void requireNoMechanism() const;
  [[nodiscard]] Surface surfaceOf(const std::string& user, const std::string& surface) const;
  [[nodiscard]] Domain domainOf(const std::string& user, const std::string& group,
                                const scene::Box& box) const;
  [[nodiscard]] bool contains(const Domain& domain, GlobalOrdinal element) const;
  [[nodiscard]] bool isCongruent() const { return !shape_.empty(); }
  [[nodiscard]] std::size_t regionOf(GlobalOrdinal element) const;
  [[nodiscard]] const scene::Material& material(std::size_t region) const;
  void pointsOf(GlobalOrdinal element, std::vector<Point>& points) const;
  void holdSupports();
  void loadSurface(const scene::SolidLoad& load);
  void loadPoint(const scene::SolidLoad& load);
  [[nodiscard]] RigidModes makeRigidModes() const;
  [[nodiscard]] GlobalOrdinal nodeAt(const scene::SolidLoad& load) const;

  std::string name_;
  const scene::Solid& solid_;
  const Mesh& mesh_;
  int components_;
  std::vector<Point> shape_; ///< corners of every element, up to a shift, where all are congruent; else empty
  std::vector<Domain> regions_;    ///< of solid_.regions
  std::vector<Domain> loaded_;     ///< of body forces, in the order of solid_.loads; others are empty
  std::vector<Held> held_;         ///< ascending by node and component
  std::vector<NodalForce> forces_; ///< ascending by element
  RigidModes rigidModes_;
  Eigen::MatrixXd freeModes_; ///< columns: combinations of the rigid modes
};

} // namespace epafi::fem
