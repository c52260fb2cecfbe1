#pragma once

/// One way to solve a quadratic program: a method, and what goes on where it finds no end.

#include "epafi/qp/solve/MprgpParameters.hpp"
#include "epafi/qp/solve/QuadraticProgram.hpp"
#include "epafi/qp/solve/Smalbe.hpp"
#include "epafi/qp/solve/SolveReport.hpp"
#include "epafi/qp/solve/StoppingRule.hpp"

namespace epafi::qp {

/// What a solve begins with.
enum class Method {
  mprgp,             ///< MPRGP; SMALBE around it where there are equations
  activeSets,        ///< ActiveSets.hpp
  conjugateGradient, ///< of programs without a set, and without equations or on Ker B (ConjugateGradient.hpp)
  /// Of Ω(x): problems with the Ω of the last solution, each by active sets; of a given Ω active sets
  fixedPoint
};

/// What methods are told.
struct SolveParameters {
  MprgpParameters mprgp = {};   ///< its limits are those of the whole solve
  SmalbeParameters smalbe = {}; ///< where there are equations
  double faceReduction = 0.1;   ///< see ActiveSetParameters
  bool beginsFree = false;      ///< whether all entries may move in the first face of active sets
  /// Products after which MPRGP gives way to active sets, which most likely were there by then, and which go
  /// on where round-off has ended it, too; 0: it does not give way.
  int patience = 0;
};

/// Solves the program by the method. Where faces of active sets do not settle, MPRGP goes on; where they
/// find no minimum, first the direction is looked for along which there is none (RecessionDirection.hpp), the
/// certificate of `unbounded`. Of Ω(x) the fixed point is looked for then: problems with the Ω of the last
/// solution, each of which has one. Active sets need few rows (ReplicatedEquality); for others it is MPRGP.
/// Conjugate gradients measure by ‖b‖, and begin in Ker B. Reports, counts and limits run through.
///
/// \param x  in: start; out: the last iterate, feasible but with conjugate gradients
/// Preconditions: Ω is not empty; ‖A‖ is known, but for conjugate gradients.
/// \throws InputError, on all ranks alike, where rows are given as a matrix, which is for QpSolver, or where
/// the maker of a face's preconditioner makes none that fits. Collective.
SolveReport solve(const QuadraticProgram& program, Method method, const Tolerances& tolerances,
                  const SolveParameters& parameters, Vector& x, Observer* observer = nullptr);

} // namespace epafi::qp
