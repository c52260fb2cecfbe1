#pragma once

/// The expansion that predicts the active set. Where many entries near their bounds depend on each other, as
/// the forces of a wide contact do, the projection of one CG step is no good: what it cuts off had balanced
/// the rest. A primal–dual active set method (Hintermüller, Ito, Kunisch, SIAM J. Optim. 13 (2003)) goes on
/// from there,
///   minimise on the face as if it had no bounds;  put the entries that leave the set on their bounds;
///   take those off whose multipliers have the wrong sign,
/// through points that may be worse than the first. It may also cycle. Here it only proposes: the best of its
/// points counts, if it is better than x^½, so that MPRGP converges as it does with the other expansions
/// (Moré, Toraldo, SIAM J. Optim. 1 (1991), look for a face that way by gradient projection).

#include "epafi/qp/solve/FacePreconditioner.hpp"
#include "epafi/qp/solve/Interruption.hpp"
#include "epafi/qp/solve/ScaledObjective.hpp"

#include <optional>

namespace epafi::qp {

/// An iterate: x, its gradient g and objective f, scaled.
struct Iterate {
  explicit Iterate(const RCP<const Map>& map) : x(map), g(map) {}
  Vector x, g;
  double f = 0;
  bool isFresh = false; ///< whether g was computed from x, not updated by a step
};

/// The vectors of a step.
struct StepVectors {
  explicit StepVectors(const RCP<const Map>& map) : p(map), image(map), trial(map) {}
  Vector p;     ///< the direction
  Vector image; ///< A times the direction or the trial point, whatever was multiplied last; not scaled
  Vector trial; ///< a point that may become the iterate
};

/// Four vectors, and two more without a preconditioner. One product a CG step in a face and a round, 10 to
/// 150 in all, 3 messages each, and one a round; allocates nothing but at first.
class ActiveSetPrediction {
public:
  /// Keeps references. \param preconditioner  null for none
  ActiveSetPrediction(ScaledObjective& objective, const ConvexSet& set, FacePreconditioner* preconditioner,
                      const Interruption& interruption, StepCounts& counts);

  /// Whether it is time for a prediction: not after it was given up, nor until steps have taken as many
  /// products as one that did not settle within the set, more of them after failures in a row, so that
  /// predictions cost no more than all the rest.
  [[nodiscard]] bool isDue() const;
  /// To be called where projections fail: takes predictions up again.
  void resume() { isGivenUp_ = false; }
  /// Makes `iterate` the best point of a prediction if its objective is below `limit`. Gives predictions up
  /// on a face without a minimum (such problems are left to the other expansions), or if the run is to end.
  /// \param leavesFace  whether entries may come off their bounds in the first round
  /// \param negligible  multipliers no larger release nothing
  /// \param work        overwritten
  /// Collective.
  bool improve(Iterate& iterate, double limit, bool leavesFace, double negligible, StepVectors& work);

private:
  void takeBoundsOff(double negligible, double share);
  bool minimiseOnFace(double& target, StepVectors& work);

  ScaledObjective& objective_;
  const ConvexSet& set_;
  std::optional<FacePreconditioner> identity_;
  FacePreconditioner& preconditioner_;
  const Interruption& interruption_;
  StepCounts& counts_;
  Iterate walker_;   ///< where the method stands; may leave the set
  Vector face_;      ///< 1 where the walker may move, else 0
  Vector wrong_;     ///< multipliers of the wrong sign
  int due_ = 0;      ///< how many products are to be spent before the next prediction
  int failures_ = 0; ///< predictions in a row that found nothing better
  bool isGivenUp_ = false;
};

} // namespace epafi::qp
