#include "epafi/adapters/BddcFactory.hpp"

#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/linear/BddcPreconditioner.hpp"

#include <Thyra_DefaultPreconditioner.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_PreconditionerFactoryBase.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Thyra_VectorSpaceBase.hpp>

#include <utility>

namespace epafi::adapters {
namespace {

Thyra::DefaultPreconditioner<double>& ours(Thyra::PreconditionerBase<double>* preconditioner) {
  auto* const made = dynamic_cast<Thyra::DefaultPreconditioner<double>*>(preconditioner);
  if (made == nullptr)
    throw Error(
        "a BDDC factory was given a preconditioner that it has not made; take one from its createPrec");
  return *made;
}

} // namespace

BddcFactory::BddcFactory(RCP<const linear::UnassembledOperator> k)
    : ConfiguredFactory("BDDC"), k_(std::move(k)) {}

/// Null if there is none that fits. \param factor  of the forward operator: it is `factor` times K
RCP<const linear::UnassembledOperator>
BddcFactory::decompositionOf(const Thyra::LinearOpSourceBase<double>& source, double& factor) const {
  const ForwardOperator forward = forwardOperator(source);
  factor = forward.factor;
  if (!forward.k.is_null() || k_.is_null())
    return forward.k;
  const auto space = Thyra::createVectorSpace<double>(k_->getRangeMap());
  return space->isCompatible(*source.getOp()->range()) ? k_ : Teuchos::null;
}

bool BddcFactory::isCompatible(const Thyra::LinearOpSourceBase<double>& source) const {
  double factor = 1;
  return !decompositionOf(source, factor).is_null() && factor != 0;
}

RCP<Thyra::PreconditionerBase<double>> BddcFactory::createPrec() const {
  return rcp(new Thyra::DefaultPreconditioner<double>);
}

void BddcFactory::initializePrec(const RCP<const Thyra::LinearOpSourceBase<double>>& source,
                                 Thyra::PreconditionerBase<double>* preconditioner,
                                 Thyra::ESupportSolveUse /*use*/) const {
  double factor = 1;
  const RCP<const linear::UnassembledOperator> k = decompositionOf(*source, factor);
  if (k.is_null() || factor == 0)
    throw InputError("BDDC knows no decomposition of the operator " + source->getOp()->description() +
                     "; it must be epafi::adapters::asThyra of an epafi::linear::UnassembledOperator, or the "
                     "factory must have one on the same map");
  const RCP<const Operator> bddc = rcp(new linear::BddcPreconditioner(k, parameters()));
  const auto op = asThyra(bddc);
  ours(preconditioner).initializeUnspecified(factor == 1 ? op : Thyra::scale(1 / factor, op));
}

void BddcFactory::uninitializePrec(Thyra::PreconditionerBase<double>* preconditioner,
                                   RCP<const Thyra::LinearOpSourceBase<double>>* source,
                                   Thyra::ESupportSolveUse* use) const {
  ours(preconditioner).uninitialize();
  if (source != nullptr)
    *source = Teuchos::null; // is not kept
  if (use != nullptr)
    *use = Thyra::SUPPORT_SOLVE_UNSPECIFIED;
}

} // namespace epafi::adapters
