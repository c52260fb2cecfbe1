#include "epafi/fetidp/Projector.hpp"

#include "epafi/base/Columns.hpp"

#include <utility>

namespace epafi::fetidp {

Projector::Projector(RCP<const Map> map, RCP<const NaturalCoarseSpace> space)
    : map_(std::move(map)), space_(std::move(space)), projected_(map_) {}

void Projector::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                      double beta) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    projected_.assign(in);
    space_->project(projected_); // x − Gᵀ(Gx)
    out.update(alpha, projected_, beta);
  });
}

} // namespace epafi::fetidp
