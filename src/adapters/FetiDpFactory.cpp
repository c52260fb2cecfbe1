#include "epafi/adapters/FetiDpFactory.hpp"

#include "epafi/base/Errors.hpp"

#include <Thyra_LinearOpWithSolveFactoryBase.hpp>

namespace epafi::adapters {
namespace {

FetiDpSolve& ours(Thyra::LinearOpWithSolveBase<double>* op) {
  auto* const solve = dynamic_cast<FetiDpSolve*>(op);
  if (solve == nullptr)
    throw Error("a FETI-DP factory was given an operator that it has not made; take one from its createOp");
  return *solve;
}

} // namespace

bool FetiDpFactory::isCompatible(const Thyra::LinearOpSourceBase<double>& source) const {
  const ForwardOperator forward = forwardOperator(source);
  return !forward.k.is_null() && forward.factor != 0;
}

RCP<Thyra::LinearOpWithSolveBase<double>> FetiDpFactory::createOp() const {
  return rcp(new FetiDpSolve);
}

void FetiDpFactory::initializeOp(const RCP<const Thyra::LinearOpSourceBase<double>>& source,
                                 Thyra::LinearOpWithSolveBase<double>* op,
                                 Thyra::ESupportSolveUse /*use*/) const {
  ours(op).initialize(source, parameters());
}

void FetiDpFactory::uninitializeOp(Thyra::LinearOpWithSolveBase<double>* op,
                                   RCP<const Thyra::LinearOpSourceBase<double>>* source,
                                   RCP<const Thyra::PreconditionerBase<double>>* preconditioner,
                                   RCP<const Thyra::LinearOpSourceBase<double>>* approximateSource,
                                   Thyra::ESupportSolveUse* use) const {
  const auto given = ours(op).uninitialize();
  if (source != nullptr)
    *source = given;
  if (preconditioner != nullptr)
    *preconditioner = Teuchos::null;
  if (approximateSource != nullptr)
    *approximateSource = Teuchos::null;
  if (use != nullptr)
    *use = Thyra::SUPPORT_SOLVE_UNSPECIFIED;
}

} // namespace epafi::adapters
