#pragma once

/// Loads on one edge of a plane element or one face of a solid one. Rows are node × components + component, as in
/// ElementIntegrals.hpp, nodes as the facet has them; of edges the points' third coordinate does not matter. Preconditions: the points' order makes the normal point outwards, as in Cell.hpp and Surface; edges go with
/// membranes, plane strain and plane stress, faces with elasticity in space. Nothing is allocated if `load` has its size.

#include "epafi/fem/Mesh.hpp"
#include "epafi/scene/Body.hpp"

#include <Eigen/Core>

#include <span>

namespace epafi::fem {

/// t∫N_a q of a constant force q per area, t the thickness (1 in space); of a membrane ∫N_a q₀, q₀ per length. Exact on edges
/// and plane faces. `load` is overwritten.
void tractionLoad(CellType facet, std::span<const Point> points, scene::Physics physics,
                  const scene::Material& material, const scene::Vector3& traction, Eigen::VectorXd& load);

/// −t∫N_a p n of a constant pressure p against the outward normal n, that of each point of the face. Exact. `load` is
/// overwritten. Precondition: not a membrane.
void pressureLoad(CellType facet, std::span<const Point> points, scene::Physics physics,
                  const scene::Material& material, double pressure, Eigen::VectorXd& load);

} // namespace epafi::fem
