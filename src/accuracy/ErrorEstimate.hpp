#pragma once

/// How far a solution is from the exact one of the scene's differential equations, in the energy norm
/// ‖v‖_K = (∫ ε(v):C:ε(v))^½ (membranes: (∫ κ|∇v|²)^½). Two parts that add up to the whole, or nearly so:
///   discretisation u_h − u: what a finer mesh would mend. Estimated by a recovered flux (RecoveredFlux.hpp):
///                   η² = Σ ∫ (q* − q_h):C⁻¹:(q* − q_h) over the elements; of order 2 more in those that do
///                   not resolve the solution. Not a bound: asymptotically exact where the solution is smooth
///   algebraic       u_h − what the iteration has: see fetidp::ContactSolution::algebraicError

#include "epafi/accuracy/RecoveredFlux.hpp"

#include <algorithm>
#include <vector>

namespace epafi::accuracy {

struct ErrorEstimate {
  double discretisation = 0; ///< η
  /// ‖u_h‖_K; where temperatures change, of the strain that has stress alone, unless that is round-off.
  double energyNorm = 0;
  /// η² of each element, in the order of Partition::elementsOf, of each of this rank's subdomains.
  std::vector<std::vector<double>> elements;
  std::vector<std::vector<double>>
      seen; ///< the same without what elements do not resolve: a form of second degree

  /// η/(‖u_h‖² + η²)^½; 0 without any energy.
  [[nodiscard]] double relative() const;
  /// η for an iteration to be balanced against: no less than 1e-5 of ‖u_h‖, where a mesh makes no error at
  /// all.
  [[nodiscard]] double toBalance() const { return std::max(discretisation, 1e-5 * energyNorm); }
};

/// Estimates the discretisation error of displacements, those of an unfinished iteration too, whose jumps
/// between subdomains then count as errors.
class ErrorEstimator {
public:
  /// Keeps references to both. Not collective.
  ErrorEstimator(const scene::Scene& scene, const model::Decomposition& decomposition);

  /// \param displacement  u at all positions of each of this rank's subdomains, components in space Two
  /// passes over the elements, one exchange of the nodes that subdomains share. Sums are the same on any
  /// number of ranks but for round-off. Collective.
  ErrorEstimate operator()(std::span<const Eigen::VectorXd> displacement);

  /// Whether elements are said to have more error than recovered fluxes see.
  [[nodiscard]] bool correctsElements() const;

  /// ‖v‖_K of a displacement beside which no temperature changes. Collective.
  double normOf(std::span<const Eigen::VectorXd> displacement);

private:
  const model::Decomposition& decomposition_;
  std::vector<BodyElements> bodies_;
  bool isHeated_; ///< whether any temperature changes
};

} // namespace epafi::accuracy
