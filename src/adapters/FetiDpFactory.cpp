#include "epafi/adapters/FetiDpFactory.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"

#include <Teuchos_VerboseObjectParameterListHelpers.hpp>
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
  ours(op).initialize(source, parameters_);
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

void FetiDpFactory::setParameterList(const RCP<Teuchos::ParameterList>& list) {
  if (list.is_null())
    throw InputError("a FETI-DP factory was given no parameter list; an empty one stands for the defaults");
  parameters_ = linear::FetiDpParameters::from(validated(*list, *getValidParameters(), ""));
  list_ = list;
  Teuchos::readVerboseObjectSublist(&*list_, this);
}

RCP<Teuchos::ParameterList> FetiDpFactory::unsetParameterList() {
  const RCP<Teuchos::ParameterList> list = list_;
  list_ = Teuchos::null;
  parameters_ = {};
  return list;
}

RCP<const Teuchos::ParameterList> FetiDpFactory::getValidParameters() const {
  static const RCP<const Teuchos::ParameterList> valid = [] {
    const RCP<Teuchos::ParameterList> list =
        rcp(new Teuchos::ParameterList(linear::FetiDpParameters::validParameters()));
    Teuchos::setupVerboseObjectSublist(&*list);
    return list;
  }();
  return valid;
}

} // namespace epafi::adapters
