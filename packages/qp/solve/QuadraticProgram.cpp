#include "epafi/qp/solve/QuadraticProgram.hpp"

#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::qp {

QuadraticProgram QuadraticProgram::shiftedBy(const RCP<const Vector>& point) const {
  QuadraticProgram shifted = *this;
  const RCP<Vector> b = rcp(new Vector(*linearTerm, Teuchos::Copy));
  hessian->apply(*point, *b, Teuchos::NO_TRANS, -1.0, 1.0);
  shifted.linearTerm = b;
  shifted.equality = Teuchos::null;
  if (!set.is_null())
    shifted.set = set->shiftedBy(*point);
  if (setAt)
    shifted.setAt = [at = setAt, point](const Vector& y) {
      Vector x(y, Teuchos::Copy);
      x.update(1.0, *point, 1.0);
      return at(x)->shiftedBy(*point);
    };
  return shifted;
}

QuadraticProgram QuadraticProgram::onKernel() const {
  QuadraticProgram program = *this;
  if (!hessianOnKernel.is_null()) {
    program.hessian = hessianOnKernel;
    program.preconditioner = preconditionerOnKernel;
  }
  return program;
}

} // namespace epafi::qp
