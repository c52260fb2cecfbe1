#pragma once

/// Fluxes (κ∇u of a membrane, the stress of an elastic body) inside one element, and how far they are from a
/// recovered flux that is continuous: what an estimate of the discretisation error is made of (Zienkiewicz,
/// Zhu, *Int. J. Numer. Meth. Engng* 24 (1987)). Preconditions are those of ElementIntegrals.hpp.

#include "epafi/fem/Solid.hpp"
#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <functional>
#include <span>

namespace epafi::fem {

/// Components of a flux: 2 of a membrane (x, y), 6 of a stress (xx, yy, zz, xy, yz, zx; 0 what the plane has
/// not; zz of solids of revolution is the hoop stress).
int numFluxes(Physics physics);

/// How many columns sampledFluxes() gives: 1 of order 1, else as many as nodes.
int numSampledFluxes(mesh::CellType type);

/// What an element's nodes have beside displacements; empty: nothing.
struct NodalState {
  std::span<const double> temperatureChange{}; ///< its strain has no stress
  std::span<const double> stiffnessFactor{};   ///< by which fluxes are multiplied
};

/// The flux as far as it is accurate, from the displacements at the nodes, node by node: of order 1 that at
/// the centre, taken as constant; of order 2 values at the nodes, of all but simplices carried on from points
/// inside, of bricks those where the flux is most accurate.
/// \param fluxes  numFluxes × numSampledFluxes, overwritten, and resized if need be
void sampledFluxes(mesh::CellType type, std::span<const Point> points, Physics physics,
                   const Material& material, std::span<const double> displacements, Eigen::MatrixXd& fluxes,
                   const NodalState& state = {});

/// Fluxes of an element at the points inside of it where they are most accurate: Shape's reducedSamples.
struct InnerFluxes {
  Eigen::Matrix3Xd places; ///< from its first node on
  Eigen::MatrixXd fluxes;  ///< numFluxes × points
};

/// \param inner  overwritten, and resized if need be
void innerFluxes(mesh::CellType type, std::span<const Point> points, Physics physics,
                 const Material& material, std::span<const double> displacements, InnerFluxes& inner,
                 const NodalState& state = {});

/// Energy norm squared of what order 2 adds to order 1: of u less its interpolant of order 1 between the
/// element's corners, by the points of the stiffness.
double quadraticEnergy(mesh::CellType type, std::span<const Point> points, Physics physics,
                       const Material& material, std::span<const double> displacements,
                       std::span<const double> stiffnessFactor = {});

/// ∫ q:C⁻¹:q, the energy norm squared of the displacement that has the flux q; for membranes ∫ |q|²/κ.
struct FluxEnergies {
  double difference = 0; ///< of q* − q_h, q* the shape functions' interpolant of fluxes at the nodes
  double flux = 0;       ///< of q_h
};

/// Exact on elements with straight edges (bricks: parallelepipeds) but of solids of revolution.
/// \param nodalFluxes q* at the nodes, numFluxes × nodes
FluxEnergies fluxEnergies(mesh::CellType type, std::span<const Point> points, Physics physics,
                          const Material& material, std::span<const double> displacements,
                          const Eigen::Ref<const Eigen::MatrixXd>& nodalFluxes, const NodalState& state = {});

/// sampledFluxes and fluxEnergies of many congruent elements of one material at once, whose temperature does
/// not change and that have no factors, as products of matrices; a column an element.
class CongruentFluxes {
public:
  /// \param points  nodes of one of them. Precondition: it is a quadrilateral or hexahedron whose
  /// Jacobian is constant; the physics is not axisymmetric.
  CongruentFluxes(mesh::CellType type, std::span<const Point> points, Physics physics,
                  const Material& material);

  /// numFluxes · numSampledFluxes × elements. \param displacements  components · nodes × elements
  [[nodiscard]] Eigen::MatrixXd sampled(const Eigen::MatrixXd& displacements) const {
    return sampled_ * displacements;
  }
  /// Of q* − q_h, of each element. \param nodalFluxes  numFluxes · nodes × elements, node by node
  [[nodiscard]] Eigen::VectorXd differences(const Eigen::MatrixXd& displacements,
                                            const Eigen::MatrixXd& nodalFluxes) const;
  /// quadraticEnergy of each element.
  [[nodiscard]] Eigen::VectorXd quadraticEnergies(const Eigen::MatrixXd& displacements) const;
  /// Of q_h, of all elements together.
  [[nodiscard]] double energy(const Eigen::MatrixXd& displacements) const {
    return displacements.cwiseProduct(stiffness_ * displacements).sum();
  }

private:
  Eigen::MatrixXd sampled_;                   ///< q_h, sampled, of u
  Eigen::MatrixXd ofFluxes_, ofDisplacement_; ///< W with ‖W_q q* − W_u u‖² = ∫ (q* − q_h):C⁻¹:(q* − q_h)
  Eigen::MatrixXd stiffness_, linear_; ///< \ref linear_ takes u to its interpolant of order 1
};

/// Energy norm squared and L2 norm squared of a displacement, or of its difference to a given field.
struct DisplacementNorms {
  double energy = 0; ///< ∫ ε:C:ε, of a membrane ∫ κ|∇u|²
  double square = 0; ///< ∫ |u|²
};

/// A displacement and its flux at a point.
struct FieldValue {
  std::array<double, 3> displacement{}; ///< as many components as the physics has
  std::array<double, 6> flux{};         ///< numFluxes(physics) of them, as if no temperature changed
};

/// Norms of u_h − u, u given at points, whatever the state's temperatures are; by a rule that is exact for
/// polynomials of degree 5 (of degree 3 on tetrahedra) of each coordinate, on elements of any form.
DisplacementNorms differenceNorms(mesh::CellType type, std::span<const Point> points, Physics physics,
                                  const Material& material, std::span<const double> displacements,
                                  const std::function<FieldValue(const Point&)>& exact,
                                  const NodalState& state = {});

} // namespace epafi::fem
