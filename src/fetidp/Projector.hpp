#pragma once

/// P = I − GᵀG, the orthogonal projector on Ker G, as an operator of its own.

#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric, P² = P: multipliers in equilibrium with no load on floating bodies.
class Projector final : public Operator {
public:
  /// \param map  of the multipliers. Shares the space. Not collective.
  Projector(RCP<const Map> map, RCP<const NaturalCoarseSpace> space);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return map_; }
  /// y = alpha P x + beta y, column after column, a message of k numbers each. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }

private:
  RCP<const Map> map_;
  RCP<const NaturalCoarseSpace> space_;
  mutable Vector projected_; ///< work
};

} // namespace epafi::fetidp
