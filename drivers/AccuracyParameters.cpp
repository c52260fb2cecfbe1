#include "AccuracyParameters.hpp"

#include "epafi/base/Parameters.hpp"

namespace epafi::drivers {

void AccuracyParameters::addTo(Teuchos::ParameterList& schema) {
  const AccuracyParameters defaults;
  Teuchos::ParameterList& list = schema.sublist("Accuracy", false, "How accurate the solution is to be.");
  list.set(
      "Estimate Error", defaults.estimate,
      "Whether the discretisation error is estimated at the end, in the energy norm, by a recovered flux "
      "(Zienkiewicz, Zhu 1987).");
  addShare(list, "Target", defaults.target,
           "Relative error in the energy norm that is asked for, such as 0.01 or \"1 %\": all meshes are "
           "refined, each "
           "start from the last one's solution, until the estimate is met. The tolerance is 'balanced' then, "
           "unless the "
           "scene gives one. 0: the scene's meshes as they are.");
  addInteger(list, "Maximum Levels", defaults.maxLevels,
             "With a target: meshes at most, the scene's own the first.", 1);
  addReal(list, "Maximum Unknowns", defaults.maxUnknowns,
          "With a target: no mesh with more unknowns is made.", 1);
}

AccuracyParameters AccuracyParameters::from(const Teuchos::ParameterList& list) {
  AccuracyParameters parameters;
  parameters.estimate = list.get<bool>("Estimate Error");
  parameters.target = list.get<double>("Target");
  parameters.maxLevels = list.get<int>("Maximum Levels");
  parameters.maxUnknowns = list.get<double>("Maximum Unknowns");
  return parameters;
}

} // namespace epafi::drivers
