#pragma once

/// Strain and stress of a solid at the points by which its elements are integrated.

#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/fem/HookesLaw.hpp"

#include <span>
#include <vector>

namespace epafi::fem {

struct PointState {
  SymmetricTensor stress{};
  SymmetricTensor strain{};        ///< (∇u + ∇uᵀ)/2
  SymmetricTensor elasticStrain{}; ///< the same without that of temperatures
};

/// At the points of the stiffness, of tetrahedra of order 2 at those of a rule of degree 2. Bricks and
/// prisms: layer by layer of the third reference coordinate, in a layer row by row of the second;
/// tetrahedra, and the triangle of a prism: the point next to the first corner first.
/// \param states  overwritten
/// Preconditions as of sampledFluxes(); elasticity in space.
void pointStates(mesh::CellType type, std::span<const Point> points, const Material& material,
                 std::span<const double> displacements, Integration integration, const NodalState& state,
                 std::vector<PointState>& states);

} // namespace epafi::fem
