#pragma once

/// The loads of a solid, element by element.

#include "epafi/fem/SolidDomains.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::fem {

class SolidLoads {
public:
  /// \throws InputError if a load names a surface or a group that is not there, meets no element or, a point load, no node.
  SolidLoads(const SolidBody& body, const SolidRegions& regions);

  /// Adds nothing: `loads` is overwritten, one column an element, rows node by node.
  void of(const SolidBody& body, const SolidRegions& regions, std::span<const GlobalOrdinal> elements,
          Eigen::MatrixXd& loads) const;

private:
  /// A force at a node, carried by one of its elements.
  struct NodalForce {
    GlobalOrdinal element, node;
    scene::Vector3 force;
  };
  /// A force per volume.
  struct BodyForce {
    SolidDomain domain;
    scene::Vector3 value;
  };

  void addSurface(const SolidBody& body, const SolidRegions& regions, const scene::SolidLoad& load);
  void addPoint(const SolidBody& body, const scene::SolidLoad& load);
  void addNodalForces(const Mesh& mesh, std::size_t components, std::span<const GlobalOrdinal> elements,
                      Eigen::MatrixXd& loads) const;

  std::vector<BodyForce> bodyForces_;
  std::vector<NodalForce> forces_; ///< ascending by element
};

} // namespace epafi::fem
