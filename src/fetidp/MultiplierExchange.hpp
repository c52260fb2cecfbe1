#pragma once

/// Between the multipliers that a rank owns and those that its subdomains touch. Plans are built once.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>

#include <span>

namespace epafi::fetidp {

class MultiplierExchange {
public:
  /// Collective.
  explicit MultiplierExchange(const decomposition::DecomposedProblem& problem)
      : import_(problem.multiplierMap, problem.multiplierGhostMap), ghost_(problem.multiplierGhostMap) {}

  /// Brings the owners' values to the ranks that touch them; valid until the next call. Collective.
  std::span<const double> toSubdomains(const Vector& owned) {
    ghost_.doImport(owned, import_, Tpetra::INSERT);
    return values();
  }
  /// Where a rank puts its contributions before `sumToOwners`. Not collective.
  std::span<double> values() {
    const auto view = ghost_.getLocalViewHost(Tpetra::Access::ReadWrite);
    return {view.data(), view.extent(0)};
  }
  /// owned = sum of the contributions of all ranks. Collective.
  void sumToOwners(Vector& owned) {
    owned.putScalar(0.0);
    owned.doExport(ghost_, import_, Tpetra::ADD);
  }

private:
  Import import_;
  Vector ghost_;
};

} // namespace epafi::fetidp
