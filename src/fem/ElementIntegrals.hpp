#pragma once

/// Stiffness and loads of one linear element of a body. Rows are node by node: node ×
/// components + component, with one component for membranes and as many as the element has dimensions otherwise.
/// Preconditions of all: points are the element's corners in the order of Cell.hpp; plane elements go with membranes, plane
/// strain and plane stress, solid ones with elasticity in space; their leastJacobian (ElementShape.hpp) is positive. Nothing is allocated if
/// the result has its size already; calls from several threads do not disturb each other.

#include "epafi/fem/Cell.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/fem/Mesh.hpp"
#include "epafi/scene/Body.hpp"

#include <Eigen/Core>

#include <span>

namespace epafi::fem {

/// ∫κ∇N_a·∇N_b of a membrane, t∫ε(N_a):σ(N_b) of an elastic body of thickness t (1 in space), by full integration. Symmetric
/// to the last bit. `stiffness` is overwritten, and resized if need be.
void elementStiffness(CellType type, std::span<const Point> points, scene::Physics physics,
                      const scene::Material& material, Eigen::MatrixXd& stiffness);

/// t∫N_a f of a constant force f per volume; of a membrane ∫N_a f₀, f₀ per area. Exact. `load` is overwritten.
void bodyForceLoad(CellType type, std::span<const Point> points, scene::Physics physics,
                   const scene::Material& material, const scene::Vector3& force, Eigen::VectorXd& load);

} // namespace epafi::fem
