#pragma once

/// The loads of a body, element by element. Keeps references to those of the solid.

#include "epafi/fem/SolidDomains.hpp"
#include "epafi/fem/SolidFactors.hpp"

#include <Eigen/Core>

#include <array>
#include <map>
#include <span>
#include <vector>

namespace epafi::fem {

class SolidLoads {
public:
  /// \throws InputError if a load names a surface or a group that is not there, meets no element or, a point
  /// load, no node.
  SolidLoads(const SolidBody& body, const SolidRegions& regions);

  /// Adds nothing: `loads` is overwritten, one column an element, rows node by node.
  void of(const SolidBody& body, const SolidRegions& regions, const SolidFactors& factors,
          std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const;

  /// Change of temperature at the nodes of an element; empty of a body of which no temperature changes.
  void temperatureChange(const mesh::Mesh& mesh, GlobalOrdinal element, std::vector<double>& change) const;

  /// One more force at a node, if the mesh, or a piece of it, has the node's elements.
  void addForceAt(const mesh::Mesh& mesh, GlobalOrdinal node, const Vector3& force);

private:
  /// A force at a node, carried by one of its elements.
  struct NodalForce {
    GlobalOrdinal element, node;
    Vector3 force;
  };
  /// A force per volume.
  struct BodyForce {
    SolidDomain domain;
    const SolidLoad* load;
  };
  /// The same on what of a structured mesh lies in a box: ∫N over the loaded part of each column, row and
  /// layer, for the functions N of one coordinate there. Products of the three are the integrals of the
  /// elements' shape functions.
  struct GridForce {
    Vector3 value;
    std::array<std::vector<std::array<double, 3>>, 3> shares;
  };

  void addGridForce(const SolidBody& body, const SolidLoad& load);
  void addSurface(const SolidBody& body, const SolidRegions& regions, const SolidLoad& load);
  void addTemperature(const SolidBody& body, const SolidLoad& load);
  void addPoint(const SolidBody& body, const SolidLoad& load);
  void enterForce(const mesh::Mesh& mesh, GlobalOrdinal node, const Vector3& force);
  void sortForces();
  void addGridForces(const SolidBody& body, const SolidRegions& regions,
                     std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const;
  void addBodyForces(const SolidBody& body, const SolidRegions& regions,
                     std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const;
  void addThermalLoads(const SolidBody& body, const SolidRegions& regions, const SolidFactors& factors,
                       std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const;
  void addNodalForces(const mesh::Mesh& mesh, int components, std::span<const GlobalOrdinal> elements,
                      Eigen::MatrixXd& loads) const;

  std::vector<GridForce> gridForces_;
  std::vector<BodyForce> bodyForces_;
  std::vector<NodalForce> forces_; ///< ascending by element
  bool isHeated_;
  double heatedBy_ = 0;                    ///< the change of temperature of the whole body
  std::map<GlobalOrdinal, double> heated_; ///< what nodes have beside it
};

} // namespace epafi::fem
