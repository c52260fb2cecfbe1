#pragma once

/// min ½xᵀAx − bᵀx without constraints: Belos's conjugate gradients.

#include "epafi/base/Types.hpp"
#include "epafi/qp/solve/SolveReport.hpp"

namespace epafi::qp {

/// Solves Ax = b to ‖b − Ax‖ ≤ tolerance · ‖b‖ from the start x. Precondition: A symmetric positive definite
/// on its domain map, and so is the preconditioner M ≈ A⁻¹, if any.
/// \param x  in: start; out: the last iterate (kept as it was if the operator returns NaN)
/// The residual reported is computed afresh. The observer's wishes cost one message a step. Collective.
SolveReport solveUnconstrained(const RCP<const Operator>& a, const RCP<const Vector>& b, const RCP<Vector>& x,
                               double tolerance, int maxMultiplications, Observer* observer = nullptr,
                               const RCP<const Operator>& preconditioner = Teuchos::null);

} // namespace epafi::qp
