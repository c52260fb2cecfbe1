#pragma once

/// A force and a moment on a surface as a traction that varies linearly along it, f + θ × (x − c), c being
/// the surface's centre: the forces at nodes balance both to round-off.

#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/SolidBody.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <functional>
#include <span>

namespace epafi::fem {

class DistributedTraction {
public:
  using MaterialAt = std::function<const Material&(std::size_t facet)>;

  /// \param load  of the kind distributed
  /// \param materialAt  of plane bodies: the thickness at a facet
  DistributedTraction(const SolidBody& body, const mesh::Surface& surface, const SolidLoad& load,
                      const MaterialAt& materialAt);

  /// ∫N_a (f + θ × (x − c)) of a facet, as tractionLoad(). `load` is overwritten.
  void of(mesh::CellType facet, std::span<const Point> points, const Material& material,
          Eigen::VectorXd& load) const;

private:
  Physics physics_;
  Eigen::Vector3d force_, turn_{0, 0, 0}, centre_{0, 0, 0};
};

} // namespace epafi::fem
