#pragma once

/// K, F, PFP and any other of our operators as Thyra sees it, for applications that speak Thyra, and the way
/// back.

#include "epafi/linear/UnassembledOperator.hpp"

#include <Thyra_LinearOpBase_decl.hpp>
#include <Thyra_LinearOpSourceBase.hpp>

namespace epafi::adapters {

/// The operator as Thyra::LinearOpBase; shares it. Domain and range are vector spaces on the operator's maps.
/// Collective.
RCP<const Thyra::LinearOpBase<double>> asThyra(const RCP<const Operator>& tpetraOperator);

/// a K, of which K is an UnassembledOperator; its transpose is the same.
struct ForwardOperator {
  RCP<const linear::UnassembledOperator> k; ///< null: it is another operator
  double factor = 1;                        ///< a
};

/// Looks through Thyra's wrappers for factors and transposes. Not collective.
ForwardOperator forwardOperator(const Thyra::LinearOpSourceBase<double>& source);

} // namespace epafi::adapters
