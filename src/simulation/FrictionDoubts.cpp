#include "epafi/base/Text.hpp"
#include "epafi/simulation/RunResult.hpp"

namespace epafi::simulation {

std::string frictionDoubts(const RunResult& result) {
  constexpr double strong = 0.5;
  const qp::StepCounts& counts = result.solve.counts;
  std::string feedback, faces;
  if (result.feedback && result.feedback->factor >= strong)
    feedback =
        "the bounds of friction feed back on themselves by a factor of " + text(result.feedback->factor, 2) +
        (result.feedback->factor < 1
             ? ": the nearer it is to 1, the less is known of whether there is one solution alone"
             : ": from 1 on there may be other solutions than this one, and nothing bounds the iteration's "
               "error");
  if (counts.fixedPointRounds > 0 && result.solve.plan.algorithm != fetidp::Algorithm::fixedPoint)
    faces = "what sticks and what slips did not settle with bounds of friction that follow the normal "
            "forces, but with given ones, in " +
            std::to_string(counts.fixedPointRounds) + " rounds: there may be other solutions than this one";
  else if (counts.negativeCurvatures > 0)
    faces = "the iteration met faces on which friction is stronger than what deforms (p'Fp < 0): from there "
            "on it is not known that there is one solution alone";
  return feedback + (feedback.empty() || faces.empty() ? "" : ". ") + faces;
}

} // namespace epafi::simulation
