#pragma once

/// The largest pressure of a contact as a sum of its multipliers. Nodes have means around them, of which the
/// largest is low where the pressure is round and high where it wiggles. So a quadratic is fitted round the
/// peak: to the nodes that are connected to that of the largest mean by others above a level, with the
/// functions' own moments,
///   min Σ τ_k A_k (Σ_i c_i ∫φ_i N̂_k/∫N̂_k − p_k)²,   p_k = ∫pN̂_k/∫N̂_k,   A_k = ∫N̂_k,
/// τ falling to 0 towards the farthest of them. Its largest value is linear in the p_k but for the place
/// where it is, which counts in second order.

#include "epafi/simulation/SolvedScene.hpp"

namespace epafi::simulation {

/// value = Σ gᵀλ, 0 where there is no force. On multiplierMap.
struct LargestPressure {
  double value = 0;
  RCP<Vector> weights; ///< g
  double remainder =
      0; ///< what the fit may be off by: half of what the next wider one changes, as it is of fourth order
  double width = 0; ///< of the wider fit's nodes
};

/// Collective. Precondition: the solution's vectors lie on the problem's multiplierMap.
LargestPressure largestPressure(const SolvedScene& solved, const contact::ContactLayout& layout);

} // namespace epafi::simulation
