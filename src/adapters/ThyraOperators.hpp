#pragma once

/// F, PFP and any other of our operators as Thyra sees it, for applications that speak Thyra.

#include "epafi/base/Types.hpp"

#include <Thyra_LinearOpBase_decl.hpp>

namespace epafi::adapters {

/// The operator as Thyra::LinearOpBase; shares it. Domain and range are vector spaces on the operator's maps.
/// Collective.
RCP<const Thyra::LinearOpBase<double>> asThyra(const RCP<const Operator>& tpetraOperator);

} // namespace epafi::adapters
