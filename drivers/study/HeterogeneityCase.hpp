#pragma once

/// One run of the heterogeneity study, measured.

#include "epafi/base/Types.hpp"
#include "epafi/scene/Scene.hpp"

#include <string>

namespace epafi::drivers {

struct HeterogeneityRun {
  bool converged = false;
  int products = 0;                 ///< with F, without those of set-up
  int constraints = 0;              ///< adaptive ones, each a product with F in the set-up
  double smallest = 0, largest = 0; ///< eigenvalues of the preconditioned Hessian, by Lanczos
  double energy = 0;
  double setup = 0, solve = 0; ///< seconds

  [[nodiscard]] double condition() const { return largest / smallest; }
};

/// Solves with the default parameters but for Adaptive Constraints/Use = `use`, and estimates the condition of what the
/// iteration works on. Collective.
HeterogeneityRun runHeterogeneous(const scene::Scene& scene, const std::string& use,
                                  const RCP<const Comm>& comm);

} // namespace epafi::drivers
