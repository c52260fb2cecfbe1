#pragma once

/// What makes Epafi's solver factories, for builders that pick them by name. Needs no more than C++17.

#include "epafi/base/Types.hpp"

#include <Teuchos_AbstractFactory.hpp>
#include <Thyra_LinearOpWithSolveFactoryBase_decl.hpp>
#include <Thyra_PreconditionerFactoryBase_decl.hpp>

namespace epafi::linear {
class UnassembledOperator;
} // namespace epafi::linear

namespace epafi::adapters {

using LinearSolveStrategy = Thyra::LinearOpWithSolveFactoryBase<double>;
using PreconditioningStrategy = Thyra::PreconditionerFactoryBase<double>;

/// Makes FetiDpFactory.
RCP<const Teuchos::AbstractFactory<LinearSolveStrategy>> fetiDpStrategy();

/// Makes BddcFactory(k). \param k  may be null
RCP<const Teuchos::AbstractFactory<PreconditioningStrategy>>
bddcStrategy(const RCP<const linear::UnassembledOperator>& k);

} // namespace epafi::adapters
