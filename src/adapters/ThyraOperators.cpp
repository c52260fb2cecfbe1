#include "epafi/adapters/ThyraOperators.hpp"

#include <Thyra_ScaledAdjointLinearOpBase.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Operator.hpp>

namespace epafi::adapters {

RCP<const Thyra::LinearOpBase<double>> asThyra(const RCP<const Operator>& tpetraOperator) {
  const auto range = Thyra::createVectorSpace<double>(tpetraOperator->getRangeMap());
  const auto domain = Thyra::createVectorSpace<double>(tpetraOperator->getDomainMap());
  return Thyra::tpetraLinearOp<double>(range, domain, Teuchos::rcp_const_cast<Operator>(tpetraOperator));
}

ForwardOperator forwardOperator(const Thyra::LinearOpSourceBase<double>& source) {
  using TpetraLinearOp = Thyra::TpetraLinearOp<double, LocalOrdinal, GlobalOrdinal, Operator::node_type>;
  ForwardOperator forward;
  double factor = 1;
  Thyra::EOpTransp transposition = Thyra::NOTRANS;
  RCP<const Thyra::LinearOpBase<double>> inner;
  Thyra::unwrap(source.getOp(), &factor, &transposition, &inner);
  const auto tpetra = Teuchos::rcp_dynamic_cast<const TpetraLinearOp>(inner);
  if (!tpetra.is_null())
    forward.k =
        Teuchos::rcp_dynamic_cast<const linear::UnassembledOperator>(tpetra->getConstTpetraOperator());
  forward.factor = factor;
  return forward;
}

} // namespace epafi::adapters
