#pragma once

/// min ½xᵀAx − bᵀx over a convex set, from start to certificate.

#include "epafi/qp/solve/Mprgp.hpp"
#include "epafi/qp/solve/QuadraticProgram.hpp"
#include "epafi/qp/solve/StoppingRule.hpp"

namespace epafi::qp {

/// Runs `solver` until `rule` holds for a gradient computed afresh: when the updated gradient says
/// "converged", one further product confirms it; should it not, the iteration goes on from the fresh
/// gradient. Returns `stagnated` if five fresh gradients in turn refuse what the updated ones promised:
/// round-off allows no more. Collective.
Status runToCertificate(Mprgp& solver, StoppingRule& rule, Observer* observer);

/// Solves a program without equations by MPRGP, starting from the projection of x.
/// \param x  in: start; out: always the last feasible iterate
/// \param tolerances  its gradient's, or the error's target, for which there has to be a preconditioner
/// Precondition: the set is not null and not empty. Collective.
SolveReport solveByMprgp(const QuadraticProgram& program, Vector& x, const Tolerances& tolerances,
                         const MprgpParameters& parameters, Observer* observer = nullptr);

/// Fills what MPRGP and SMALBE report alike: the reason, the norm, a fresh gradient, a certificate. Not
/// collective but for the certificate.
void describeEnd(Mprgp& solver, SolveReport& report);

} // namespace epafi::qp
