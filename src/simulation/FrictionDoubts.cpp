#include "epafi/base/Text.hpp"
#include "epafi/simulation/RunResult.hpp"

namespace epafi::simulation {

void addDoubt(const std::string& doubt, RunResult& result) {
  if (!doubt.empty())
    result.doubts += (result.doubts.empty() ? "" : ". ") + doubt;
}

std::string frictionDoubts(const std::optional<FrictionFeedback>& feedback,
                           const UnsettledFriction& unsettled) {
  constexpr double strong = 0.5;
  std::string doubts;
  const auto add = [&](const std::string& doubt) { doubts += (doubts.empty() ? "" : ". ") + doubt; };
  if (feedback && feedback->factor >= strong)
    add("the bounds of friction feed back on themselves by a factor of " + text(feedback->factor, 2) +
        (feedback->factor < 1
             ? ": the nearer it is to 1, the less is known of whether there is one solution alone"
             : ": from 1 on there may be other solutions than this one, and nothing bounds the iteration's "
               "error"));
  if (unsettled.fixedPointRounds > 0)
    add("what sticks and what slips did not settle with bounds of friction that follow the normal forces, "
        "and "
        "was found with given bounds, in " +
        std::to_string(unsettled.fixedPointRounds) + " rounds: there may be other solutions than this one");
  else if (unsettled.negativeCurvatures > 0)
    add("on its way the iteration met faces on which friction is stronger than what deforms (p'Fp < 0): the "
        "coefficient is beyond those for which one solution alone is known");
  return doubts;
}

} // namespace epafi::simulation
