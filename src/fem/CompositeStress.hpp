#pragma once

/// Stresses inside one plane element that balance given tractions on its edges and a constant load exactly:
/// what guaranteed error bounds are made of. The element is cut into the triangles between its edges and its
/// centre; on each of them the stress is a polynomial of the element's order, its tractions agree between
/// them (C. Johnson, B. Mercier, *Numer. Math.* 30 (1978); M. Křížek, *Apl. Mat.* 27 (1982)). Symmetric
/// stresses of elastic bodies are multiplied with the thickness; a membrane has its flux.
///
/// *Data* of an element are, edge by edge and node by node, the moments ∫ t N_a of the outward tractions t,
/// components in space, and then the load per area: numData() numbers. A stress exists where they are in
/// balance, forces and moments.

#include "epafi/fem/Solid.hpp"
#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/Mesh.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace epafi::fem {

/// Abscissae in [0, 1] and weights of Gauss's rule for degree 7.
inline constexpr std::array<std::array<double, 2>, 4> fourGauss{{{0.069431844202973712, 0.17392742256872693},
                                                                 {0.33000947820757187, 0.32607257743127307},
                                                                 {0.66999052179242813, 0.32607257743127307},
                                                                 {0.93056815579702629, 0.17392742256872693}}};

/// What holds on the reference element, for triangles or quadrilaterals of one order and membranes or elastic
/// bodies. Numbers of a stress: part by part, function by function, component by component (x, y; xx, yy,
/// xy).
class CompositeCell {
public:
  /// Made once for each. \param components  1 of membranes, 2 of elastic bodies
  static const CompositeCell& of(mesh::CellType type, int components);

  [[nodiscard]] int numData() const { return numTractions() + components; }
  [[nodiscard]] int numTractions() const { return numFacets * perFacet * components; }

  mesh::CellType type;
  int components, numFluxes, numFacets, perFacet;
  Eigen::MatrixXd stresses;              ///< a column for each of the data, then those that need none
  std::vector<Eigen::MatrixXd> products; ///< ∫ of these, for each pair k ≤ l of components
  // At points that are enough for squares of stresses:
  Eigen::MatrixXd sampled;   ///< the stresses, a column each, point by point
  Eigen::MatrixXd gradients; ///< of the element's shape functions, a column each, point by point
  Eigen::VectorXd weights;
  // At the points of `fourGauss` on each edge:
  Eigen::MatrixXd edgeGradients; ///< likewise
  Eigen::MatrixXd edgeShares;    ///< weights times the functions of an edge, a column each

private:
  CompositeCell(mesh::CellType cellType, int numComponents);
  void solve();
  void integrate();
};

/// One element of a body. Precondition: its map is affine.
class CellStress {
public:
  CellStress(mesh::CellType type, std::span<const Point> points, Physics physics, const Material& material);

  [[nodiscard]] int numData() const { return cell_->numData(); }
  [[nodiscard]] int numTractions() const { return cell_->numTractions(); }
  [[nodiscard]] double measure() const; ///< area

  /// E with dᵀEd = ∫ τ:C⁻¹:τ of the stress τ that has the data d and the least energy.
  [[nodiscard]] const Eigen::MatrixXd& energy() const;
  /// Moments of the tractions of the stress of displacements at the nodes.
  [[nodiscard]] Eigen::VectorXd tractions(const Eigen::VectorXd& displacements) const;
  /// ∫ (τ − σ):C⁻¹:(τ − σ), σ the stress of displacements at the nodes, τ that of energy().
  [[nodiscard]] double difference(const Eigen::VectorXd& data, const Eigen::VectorXd& displacements) const;

private:
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  template <int numFluxes>
  [[nodiscard]] Eigen::Matrix<double, numFluxes, Eigen::Dynamic>
  stressesAt(const Eigen::MatrixXd& gradients, const Eigen::VectorXd& displacements) const;
  template <int numFluxes>
  [[nodiscard]] double differenceOf(const Eigen::VectorXd& data, const Eigen::VectorXd& displacements) const;
  void integrate() const;

  const CompositeCell* cell_;
  Eigen::Matrix2d jacobian_, inverse_;
  Small law_, compliance_, piola_; ///< D of strains, D⁻¹; τ of τ̂
  // Made when they are asked for:
  mutable Eigen::MatrixXd whole_; ///< energies of all stresses of the cell
  mutable Eigen::MatrixXd least_; ///< those without data that make the energy the least, of data
  mutable Eigen::MatrixXd energy_;
};

/// The flux through a line with a normal, components × numFluxes, of a membrane or an elastic body.
Eigen::MatrixXd throughLine(const Eigen::Vector2d& normal, int components);

} // namespace epafi::fem
