#pragma once

/// Primal–dual active sets for min ½xᵀAx − bᵀx, Bx = c, x in Ω. Hintermüller, Ito, Kunisch, *SIAM J. Optim.*
/// 13 (2003); for FETI the planning steps of Avery, Rebel, Lesoinne, Farhat, *Comput. Methods Appl. Mech.
/// Engrg* 193 (2004):
///   minimise on the face as if it had no bounds, Bx = c held exactly, as far as the next decision needs;
///   put the entries that left Ω on its boundary, and let those move whose multipliers have the wrong sign,
///   all at once; along circles (Discs.hpp) they move on, in Newton steps for the curved boundary (Face.hpp).
/// Few faces where the first is near the last one, and no outer iteration for Bx = c. Where the faces do not
/// settle, a primal method goes on in Ω (Nocedal, Wright, *Numerical Optimization*, 2006, 16.5), slower and
/// with an objective that falls, unless Ω is curved or moves; where round-off ends that too, the method says
/// so.

#include "epafi/qp/solve/MprgpParameters.hpp"
#include "epafi/qp/solve/QuadraticProgram.hpp"
#include "epafi/qp/solve/SolveReport.hpp"
#include "epafi/qp/solve/StoppingRule.hpp"

namespace epafi::qp {

/// How faces are gone through.
struct ActiveSetParameters {
  /// What CG takes ‖Zg‖ and (gᵀMg)^½ down to before a face is looked at, a share of them where it was
  /// entered. Of both: the energy alone can be that of one direction which M overrates, gone after a step;
  /// the norm alone, that of one which hardly moves x. With less reduction wrong decisions are paid by
  /// further faces, with more right ones by steps.
  double faceReduction = 0.1;
  /// 1 where x may move at first, else 0; if null the start's own face, or, where the start is 0, the face to
  /// which Mb points, pairs in discs being free there.
  const Vector* firstFace = nullptr;
};

/// \param x       in: start; out: the last point, in Ω
/// \param limits  of products and time
/// Precondition: A is positive definite on Ker B, whose rows are few (ReplicatedEquality); M ≈ A⁻¹ is used as
/// P_F M P_F.
///
/// Costs of a step: 1 product, 1 application of M, 2 reductions; of a face: 1 product (none at the start
/// 0), 5 reductions (4 without rows). Steps allocate nothing; a face what B's inverse on it takes
/// (FaceInverse.hpp) and, with `setAt`, the set of its point. Returns converged only for a gradient
/// computed afresh; with the best point met stagnated, where faces do not settle, and unbounded, where
/// one seems to have no minimum (whether it has none says RecessionDirection.hpp). With a set that
/// depends on x, bounds are those of the last face while a face lasts (Hüeber, Wohlmuth, *Comput. Methods
/// Appl. Mech. Engrg* 194 (2005)), and what they miss of Ω(x), times ‖A‖, counts as gradient. Where the set
/// knows how they grow and few entries change, x follows them: a step takes more reductions then
/// (FaceIteration.hpp), and two vectors are kept for each step of the longest face. Collective.
SolveReport solveByActiveSets(const QuadraticProgram& program, Vector& x,
                              const ActiveSetParameters& parameters, const Tolerances& tolerances,
                              const MprgpParameters& limits, Observer* observer = nullptr);

} // namespace epafi::qp
