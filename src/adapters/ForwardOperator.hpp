#pragma once

/// The UnassembledOperator that a Thyra operator wraps.

#include "epafi/linear/UnassembledOperator.hpp"

#include <Thyra_LinearOpBase_decl.hpp>
#include <Thyra_LinearOpSourceBase.hpp>

namespace epafi::adapters {

/// a K, of which K is an UnassembledOperator; its transpose is the same.
struct ForwardOperator {
  RCP<const linear::UnassembledOperator> k; ///< null: it is another operator
  double factor = 1;                        ///< a
};

/// Looks through Thyra's wrappers for factors and transposes. Not collective.
ForwardOperator forwardOperator(const Thyra::LinearOpSourceBase<double>& source);

} // namespace epafi::adapters
