#include "epafi/fetidp/Projector.hpp"

#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::fetidp {

Projector::Projector(RCP<const Map> map, RCP<const NaturalCoarseSpace> space)
    : SymmetricOperator(std::move(map)), space_(std::move(space)) {}

void Projector::multiply(const MultiVector& x, MultiVector& y) const {
  y.assign(x);
  for (std::size_t column = 0; column < y.getNumVectors(); ++column)
    space_->project(*y.getVectorNonConst(column)); // x − Gᵀ(Gx)
}

} // namespace epafi::fetidp
