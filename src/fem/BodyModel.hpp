#pragma once

/// The physics of one body: element matrices and loads, supports, and the rigid modes that the supports leave
/// free. What comes after `fem` never knows which physics it is.

#include "epafi/decomposition/RigidModes.hpp"
#include "epafi/decomposition/RigidMotions.hpp"
#include "epafi/fem/Solid.hpp"
#include "epafi/fem/SolidBody.hpp"
#include "epafi/fem/SolidDomains.hpp"
#include "epafi/fem/SolidFactors.hpp"
#include "epafi/fem/SolidLoads.hpp"
#include "epafi/fem/SolidSupports.hpp"
#include "epafi/fem/UnknownMap.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace epafi::fem {

/// A node's unknowns are its displacement's components along the axes of space, or of its frame if it has
/// one. Stiffness, loads, prescribed values and kernel are all in these unknowns.
class BodyModel {
public:
  /// Keeps references to solid and mesh. \throws InputError, with the body's name, if a surface or group that
  /// the solid names is not in the mesh, a region or load meets no element, a point load no node, supports
  /// contradict each other or hardly hold the body, the physics does not go with the mesh's dimension, parts
  /// of the body are not joined, or those of an elastic one in nodes or edges only: a mechanism.
  BodyModel(const Solid& body, const mesh::Mesh& mesh);

  [[nodiscard]] const mesh::Mesh& mesh() const { return body_.mesh; } ///< that of the body
  /// Of a piece of a mesh, what the solid names: one piece at least has to have it.
  [[nodiscard]] const std::vector<SolidBody::Need>& needs() const { return body_.needs(); }
  /// One more load: a force in space at a node, if the mesh, or a piece of it, has the node's elements.
  void addForce(GlobalOrdinal node, const Eigen::Vector3d& force) {
    loads_.addForceAt(body_.mesh, node, {force[0], force[1], force[2]});
  }
  /// Where its unknowns are.
  [[nodiscard]] const UnknownMap& unknowns() const { return unknowns_; }
  /// Unknowns a node.
  [[nodiscard]] int components() const { return unknowns_.components(); }
  /// Rigid modes that the supports leave free: known from the supports, not from round-off.
  [[nodiscard]] int kernelDimension() const { return static_cast<int>(freeModes_.cols()); }
  /// Value of a rigid mode at a node and component, mode < kernelDimension().
  [[nodiscard]] double kernelValue(GlobalOrdinal node, int component, int mode) const;
  /// The rigid motions as motions in space; nothing of a scalar field.
  [[nodiscard]] std::optional<decomposition::RigidMotions> rigidMotions() const;
  /// Whether it is one about the y-axis, along which alone it moves rigidly.
  [[nodiscard]] bool isOfRevolution() const { return body_.solid.physics == Physics::axisymmetric; }
  /// The node's frame, a rotation whose columns are the axes of its unknowns, or null where these are those
  /// of space. In the plane it turns about z.
  [[nodiscard]] const Eigen::Matrix3d* frame(GlobalOrdinal node) const { return supports_.frame(node); }
  /// Whether any node has one.
  [[nodiscard]] bool hasFrames() const { return supports_.hasFrames(); }
  /// Prescribed value of a node's component, or nothing where it is free.
  [[nodiscard]] std::optional<double> prescribed(GlobalOrdinal node, int component) const {
    return supports_.value(node, component);
  }
  /// All prescribed values at some ascending nodes; `values` is overwritten.
  void prescribed(std::span<const GlobalOrdinal> nodes, std::vector<PrescribedValue>& values) const {
    supports_.values(nodes, values);
  }

  /// Kind of each element: elements of one kind have the same stiffness, to the last bit.
  void kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const;
  /// Region of the solid that each element lies in: the last one that contains it, counted from 1; 0 outside
  /// of all.
  void regions(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> regions) const {
    regions_.of(body_, elements, regions);
  }
  /// Stiffness of the elements of a kind; size nodes · components, node by node.
  void stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const;
  /// Loads of elements, one column each, as long as the largest stiffness; 0 behind the element's own.
  void loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const;
  /// Stiffness and load of one element, of one size.
  void element(GlobalOrdinal element, Eigen::MatrixXd& stiffness, Eigen::VectorXd& load) const;

  /// Change of temperature at the nodes of an element; empty of a body of which no temperature changes.
  void temperatureChange(GlobalOrdinal element, std::vector<double>& change) const {
    loads_.temperatureChange(body_.mesh, element, change);
  }

  /// By what the stiffness is multiplied at the nodes of an element; empty of a body without such factors.
  void stiffnessFactors(GlobalOrdinal element, std::vector<double>& factors) const {
    factors_.of(body_.mesh, element, factors);
  }

  /// What an element is made of, but for these factors.
  [[nodiscard]] const Material& materialOf(GlobalOrdinal element) const {
    return materialIn(body_.solid, regions_.of(body_, element));
  }

private:
  void integrateRegions();
  void findFreeModes();
  void findFramedElements();
  /// Whether a node of the element has a frame.
  [[nodiscard]] bool isFramed(GlobalOrdinal element) const;
  void turnIntoFrames(GlobalOrdinal element, Eigen::MatrixXd& stiffness) const;
  void turnIntoFrames(GlobalOrdinal element, Eigen::Ref<Eigen::VectorXd> load) const;

  SolidBody body_;
  UnknownMap unknowns_;
  SolidRegions regions_;
  SolidFactors factors_;
  SolidLoads loads_;
  SolidSupports supports_;
  std::vector<Eigen::MatrixXd> stiffnesses_;  ///< of each region, if elements are congruent
  std::vector<GlobalOrdinal> framedElements_; ///< ascending
  decomposition::RigidModes rigidModes_;
  Eigen::MatrixXd freeModes_; ///< columns: combinations of the rigid modes
};

} // namespace epafi::fem
