#pragma once

/// Stresses in the elements of a body that balance given tractions and loads (CompositeCell.hpp).

#include "epafi/fem/CompositeCell.hpp"
#include "epafi/fem/Solid.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::fem {

/// One element of a body. Precondition: its map is affine.
class CellStress {
public:
  CellStress(mesh::CellType type, std::span<const Point> points, Physics physics, const Material& material);

  [[nodiscard]] int numData() const { return cell_->numData(); }
  [[nodiscard]] int numTractions() const { return cell_->numTractions(); }
  [[nodiscard]] double measure() const; ///< area or volume

  /// E with dᵀEd = ∫ τ:C⁻¹:τ of the stress τ that has the data d and the least energy.
  [[nodiscard]] const Eigen::MatrixXd& energy() const;
  /// Moments of the tractions of the stress of displacements at the nodes.
  [[nodiscard]] Eigen::VectorXd tractions(const Eigen::VectorXd& displacements) const;
  /// ∫ (τ − σ):C⁻¹:(τ − σ), σ the stress of displacements at the nodes, τ that of energy(). Precondition: the
  /// data are in balance. \param energy  dᵀEd \param stiffness  of the element
  [[nodiscard]] double difference(double energy, const Eigen::VectorXd& data,
                                  const Eigen::VectorXd& displacements,
                                  const Eigen::MatrixXd& stiffness) const;

private:
  [[nodiscard]] Eigen::VectorXd stressOf(const Eigen::MatrixXd& gradient) const;

  const CompositeCell* cell_;
  Eigen::MatrixXd jacobian_, inverse_, law_; ///< D of strains
  std::vector<Eigen::MatrixXd> through_;     ///< each facet
  mutable Eigen::MatrixXd energy_;           ///< made when it is asked for
};

} // namespace epafi::fem
