#pragma once

/// Between the multipliers that a rank owns and those that its subdomains touch, of several vectors at once.
/// The plan is built once and shared.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace epafi::fetidp {

class MultiplierExchange {
public:
  /// \param plan  from multiplierMap to multiplierGhostMap. Not collective.
  explicit MultiplierExchange(RCP<const Import> plan)
      : import_(std::move(plan)), ghost_(rcp(new MultiVector(import_->getTargetMap(), 1))) {}

  /// Brings the owners' values to the ranks that touch them, column after column; valid until the next call.
  /// Collective.
  std::span<const double> toSubdomains(const MultiVector& owned) {
    prepare(owned.getNumVectors());
    ghost_->doImport(owned, *import_, Tpetra::INSERT);
    return view();
  }
  /// Where a rank puts its contributions before `sumToOwners`, column after column. Not collective.
  std::span<double> values(std::size_t numColumns = 1) {
    prepare(numColumns);
    return view();
  }
  /// The same, with zeros.
  std::span<double> zeros(std::size_t numColumns = 1) {
    const std::span<double> all = values(numColumns);
    std::fill(all.begin(), all.end(), 0.0);
    return all;
  }
  /// owned = sum of the contributions of all ranks. Precondition: it has as many columns. Collective.
  void sumToOwners(MultiVector& owned) {
    owned.putScalar(0.0);
    owned.doExport(*ghost_, *import_, Tpetra::ADD);
  }

private:
  void prepare(std::size_t numColumns) {
    if (ghost_->getNumVectors() != numColumns)
      ghost_ = rcp(new MultiVector(ghost_->getMap(), numColumns));
  }
  std::span<double> view() {
    const auto values =
        ghost_->getLocalViewHost(Tpetra::Access::ReadWrite); // its own: no gaps between columns
    return {values.data(), values.extent(0) * values.extent(1)};
  }

  RCP<const Import> import_;
  RCP<MultiVector> ghost_;
};

} // namespace epafi::fetidp
