#include "epafi/adapters/ThyraOperators.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Operator.hpp>

namespace epafi::adapters {

RCP<const Thyra::LinearOpBase<double>> asThyra(const RCP<const Operator>& tpetraOperator) {
  const auto range = Thyra::createVectorSpace<double>(tpetraOperator->getRangeMap());
  const auto domain = Thyra::createVectorSpace<double>(tpetraOperator->getDomainMap());
  return Thyra::tpetraLinearOp<double>(range, domain, Teuchos::rcp_const_cast<Operator>(tpetraOperator));
}

} // namespace epafi::adapters
