#pragma once

/// P = I − GᵀG, the orthogonal projector on Ker G, as an operator of its own.

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric, P² = P: multipliers in equilibrium with no load on floating bodies. A product
/// takes a message of k numbers a column.
class Projector final : public SymmetricOperator {
public:
  /// \param map  of the multipliers. Shares the space. Not collective.
  Projector(RCP<const Map> map, RCP<const NaturalCoarseSpace> space)
      : SymmetricOperator(std::move(map)), space_(std::move(space)) {}

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    y.assign(x);
    for (std::size_t column = 0; column < y.getNumVectors(); ++column)
      space_->project(*y.getVectorNonConst(column)); // x − Gᵀ(Gx)
  }

  RCP<const NaturalCoarseSpace> space_;
};

} // namespace epafi::fetidp
