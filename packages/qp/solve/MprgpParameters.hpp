#pragma once

/// What MPRGP can be told. No parameter has units: lengths of steps are multiples of 1/‖A‖.

#include <Teuchos_ParameterList.hpp>

namespace epafi::qp {

/// Where a conjugate gradient step that would leave the set goes from its feasible half step x^½ = x − α_f p.
enum class Expansion {
  /// projectedCg; with a preconditioner, once one of its steps raised the objective by much, activeSet
  automatic,
  projectedCg, ///< P(x − α_cg p) (MPPCG; Kružík, Horák, Čermák, Pospíšil, Pecha 2020)
  fixedStep,   ///< P(x^½ − ᾱ φ(x^½)), ᾱ = Expansion Step/‖A‖ (Dostál, Schöberl 2005)
  /// Where a primal–dual active set method leads (Hintermüller, Ito, Kunisch, *SIAM J. Optim.* 13 (2003))
  activeSet
};

struct MprgpParameters {
  double proportioningConstant = 0; ///< Γ > 0; 0: not chosen, which is 1 but where the caller knows better
  Expansion expansion = Expansion::automatic;
  /// Of a CG step that meets the boundary: with at least this share it is good enough, and ends there (a cut
  /// to the share s has 1 − (1 − s)² of the decrease); 1: never; 0: not chosen, which is 1 but where the
  /// caller knows better.
  double sufficientShare = 0;
  double expansionStep = 1.9;     ///< ᾱ‖A‖, in (0, 2)
  int maxMultiplications = 10000; ///< products with A at most
  double timeLimit = 0;           ///< seconds; 0 for none

  /// All of them with defaults, ranges and meaning.
  static Teuchos::ParameterList validParameters();
  /// From a validated list.
  static MprgpParameters from(const Teuchos::ParameterList& list);
};

} // namespace epafi::qp
