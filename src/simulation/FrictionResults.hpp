#pragma once

/// What friction does on a contact: forces, where it sticks and slips, and what it takes of the energy.

#include "epafi/base/Slab.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <array>
#include <vector>

namespace epafi::simulation {

/// Sums over a contact. Forces are those of the scene's first body on the second one, or on the obstacle.
struct FrictionResult {
  std::array<double, 3> tangentialForce{}; ///< Σ λ_t
  std::array<double, 3> moment{}; ///< of pressure and friction about the origin, per thickness in the plane
  std::array<double, 3> tangentialMoment{};                 ///< of friction alone
  std::array<double, 3> centre{};                           ///< of the surface that may touch, by area
  std::array<double, 3> centreMoment{}, centreTangential{}; ///< those two about the centre
  double stickArea = 0, slipArea = 0, openArea = 0;         ///< of closed nodes, and of the others
  double dissipation = 0;                                   ///< Σ λ_tᵀw, w what a node slips
  double largestSlip = 0;                                   ///< |w| of a closed node
};

/// How a node of a contact with friction is.
enum class FrictionState { open, slip, stick };

/// Friction at this rank's slab of ContactLayout::ownRows.
struct FrictionFields {
  std::vector<double> traction; ///< on the second side, as the pressure is a mean around a node, 3 a node
  std::vector<double> slip;     ///< w, by how much the first side slips on the second, 3 a node
  std::vector<int> state;       ///< FrictionState
};

/// Precondition: the contact has friction. Collective.
/// \param areas  of all rows, as far as they are the contact's own (ContactState)
FrictionResult frictionResult(const SolvedScene& solved, const contact::ContactLayout& contact,
                              const std::vector<double>& areas);

/// Likewise.
FrictionFields frictionFields(const SolvedScene& solved, const contact::ContactLayout& contact);

} // namespace epafi::simulation
