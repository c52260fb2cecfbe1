#pragma once

/// Stiffness and loads of one element of a body, and loads on its facets. Rows are node by node: node ×
/// components + component, with one component for membranes and as many as the element has dimensions
/// otherwise. Preconditions of those of elements: points are the element's nodes in the order of Cell.hpp;
/// plane elements go with all but elasticity in space, solid ones with that; points are where they are of
/// solids of revolution, else up to a shift;
/// their leastJacobian (ElementGeometry.hpp) is positive. Nothing is allocated if the result has its size
/// already; calls from several threads do not disturb each other.

#include "epafi/fem/HookesLaw.hpp"
#include "epafi/fem/Solid.hpp"
#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::fem {

/// By which points to integrate.
enum class Integration {
  full,   ///< what the quantity asks for
  reduced ///< Shape's reducedSamples: quadrilaterals and bricks of order 2, and their facets
};

/// That of a body's elements.
inline Integration integrationOf(const Solid& body) {
  return body.reducedIntegration ? Integration::reduced : Integration::full;
}

/// ∫κ∇N_a·∇N_b of a membrane, t∫ε(N_a):σ(N_b) of an elastic body of thickness t (1 in space; here and below
/// 2πr under the integral of solids of revolution, r = x, which also have ε_zz = u_x/r). Symmetric to the
/// last bit. `stiffness` is overwritten, and resized if need be.
/// \param factors  at the nodes, by which σ is multiplied in between; empty: 1
void elementStiffness(mesh::CellType type, std::span<const Point> points, Physics physics,
                      const Material& material, Eigen::MatrixXd& stiffness,
                      Integration integration = Integration::full, std::span<const double> factors = {});

/// The least factor at the points of the stiffness and in the finer rules of loads and estimates. Where it is
/// not positive the nodes' factors are too far apart for one element.
double leastFactor(mesh::CellType type, std::span<const double> factors);

/// t∫N_a f of a constant force f per volume; of a membrane ∫N_a f₀, f₀ per area. Exact by full integration.
/// `load` is overwritten.
void bodyForceLoad(mesh::CellType type, std::span<const Point> points, Physics physics,
                   const Material& material, const Vector3& force, Eigen::VectorXd& load,
                   Integration integration = Integration::full);

/// t∫N_a q r of a force per volume that grows with the distance r from an axis: q = value[0] of a load of the
/// kind rotation, r(x) from its axis to x, perpendicular to it. `load` is overwritten. Precondition: not a
/// membrane; in the plane the axis is perpendicular to it, of solids of revolution it is the y-axis.
void rotationLoad(mesh::CellType type, std::span<const Point> points, Physics physics,
                  const Material& material, const SolidLoad& rotation, Eigen::VectorXd& load,
                  Integration integration = Integration::full);

/// t∫ε(N_a):C:ε₀ of the strain ε₀ of a change of temperature, by the points of the stiffness. `load` is
/// overwritten. \param temperatureChange  at each node \param factors  as of the stiffness
/// Precondition: not a membrane.
void thermalLoad(mesh::CellType type, std::span<const Point> points, Physics physics,
                 const Material& material, std::span<const double> temperatureChange, Eigen::VectorXd& load,
                 Integration integration = Integration::full, std::span<const double> factors = {});

// Loads on one edge of a plane element or one face of a solid one: rows as above, nodes as the facet has
// them, in an order that makes the normal point outwards, as in Cell.hpp and Surface. Edges go with
// all but elasticity in space, and their points' third coordinate does not matter; faces go with that.

/// t∫N_a q of a constant force q per area, t the thickness (1 in space); of a membrane ∫N_a q₀, q₀ per
/// length. Exact on edges and plane faces. `load` is overwritten.
void tractionLoad(mesh::CellType facet, std::span<const Point> points, Physics physics,
                  const Material& material, const Vector3& traction, Eigen::VectorXd& load,
                  Integration integration = Integration::full);

/// A point of a rule that is exact for tractions linear in place, on facets with straight edges.
struct FacetSample {
  double weight; ///< with thickness, or circumference
  Eigen::Vector3d place;
  Eigen::VectorXd values; ///< N_a
};
std::vector<FacetSample> facetSamples(mesh::CellType facet, std::span<const Point> points, Physics physics,
                                      const Material& material);

/// −t∫N_a p n of a constant pressure p against the outward normal n, that of each point of the face. Exact by
/// full integration. `load` is overwritten. Precondition: not a membrane.
void pressureLoad(mesh::CellType facet, std::span<const Point> points, Physics physics,
                  const Material& material, double pressure, Eigen::VectorXd& load,
                  Integration integration = Integration::full);

} // namespace epafi::fem
