#pragma once

/// Belos' conjugate gradients, set up: for whoever has a test of its own for the end. Heavy: for sources
/// alone.

#include "epafi/base/Types.hpp"

#include <BelosLinearProblem.hpp>
#include <BelosStatusTest.hpp>
#include <BelosTpetraAdapter.hpp>

#include <vector>

namespace epafi::qp {

using BelosProblem = Belos::LinearProblem<double, MultiVector, Operator>; ///< Ax = b
using BelosIteration = Belos::Iteration<double, MultiVector, Operator>;   ///< what a test sees
using BelosTest = Belos::StatusTest<double, MultiVector, Operator>;       ///< says when it is over

struct BelosOutcome {
  int steps = 0;
  bool isIndefinite = false; ///< ended by pᵀAp ≤ 0, rᵀMr < 0, or NaN
};

/// From the problem's present solution until the test has passed, columns side by side in one product a step,
/// each with its own step lengths. \param columns of the solution, which is updated. Collective.
BelosOutcome iterate(const RCP<BelosProblem>& problem, const std::vector<int>& columns,
                     const RCP<BelosTest>& test);

} // namespace epafi::qp
