#include "epafi/simulation/AccuracyParameters.hpp"

#include "epafi/base/PeakMemory.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"

#include <string>
#include <vector>

namespace epafi::simulation {
namespace {

const std::vector<std::string> refinements{"local", "even"}, boundKinds{"none", "guaranteed"};

} // namespace

void AccuracyParameters::addTo(Teuchos::ParameterList& schema) {
  const AccuracyParameters defaults;
  Teuchos::ParameterList& list = schema.sublist("Accuracy", false, "How accurate the solution is to be.");
  list.set(
      "Estimate Error", defaults.estimate,
      "Whether the discretisation error is estimated at the end, in the energy norm, by a recovered flux "
      "(Zienkiewicz, Zhu 1987).");
  list.set("Small Displacements", defaults.requiresSmall,
           "Whether a run whose strains or rotations are above a fifth (20 %, 11°), so that small "
           "displacements are no model, ends with code 1. Above a tenth there is a doubt in any case.");
  addChoice(
      list, "Bound", boundKinds.front(),
      "guaranteed: the exact energy is bounded from both sides, and with it the error in the energy norm, "
      "by a displacement that does not penetrate and a stress in balance with the loads. All bodies but "
      "solids of revolution, contact node by node without friction.",
      boundKinds);
  addInteger(list, "Coarser Start", static_cast<int>(defaults.coarserFrom),
             "Without a target: elastic scenes with contact and so many unknowns or more look for the "
             "contact zone on a coarser mesh "
             "first, and are solved by active sets if nothing else is asked for: elements of order 1 on the "
             "same mesh if those of the "
             "scene are of order 2; else grids of half as many cells each way, and geometries with elements "
             "twice as large. 0: never.",
             0);
  addShare(list, "Target", defaults.target,
           "Relative error in the energy norm, or of a Quantity, that is asked for, such as 0.01 or \"1 %\", "
           "also by --accuracy: "
           "mesh after mesh, each started from the last one's solution, until the estimate is met. The "
           "tolerance is 'balanced' then, 1e-8 for a Quantity, unless the scene gives one. 0: the scene's "
           "meshes as "
           "they are.");
  addChoice(
      list, "Refinement", refinements.front(),
      "With a target: local: the first mesh is as coarse as the scene allows (of a mesh file: its own), and "
      "triangles or tetrahedra are refined where the error is; a geometry is meshed anew. even: the scene's "
      "own mesh, and all its elements are halved.",
      refinements);
  addInteger(
      list, "Order", defaults.order,
      "With local refinement: order of the elements, whatever the bodies say. 0: 2, or 1 where this takes "
      "fewer unknowns.",
      0, 2);
  addInteger(list, "Maximum Levels", defaults.maxLevels, "With a target: meshes at most.", 1);
  addReal(list, "Maximum Unknowns", 0, "With a target: no mesh with more unknowns is made. 0: no limit.", 0);
  addReal(list, "Maximum Seconds", 0,
          "With a target: no mesh is begun that would not be ready by then. 0: no limit.", 0);
  addReal(list, "Maximum Memory", 0,
          "With a target: no mesh is made that would take more, in GB, on all ranks together. 0: four fifths "
          "of what "
          "is free on this machine.",
          0);
  QuantityParameters::addTo(list);
}

AccuracyParameters AccuracyParameters::from(const Teuchos::ParameterList& list) {
  AccuracyParameters parameters;
  parameters.estimate = list.get<bool>("Estimate Error");
  parameters.requiresSmall = list.get<bool>("Small Displacements");
  parameters.bound = list.get<std::string>("Bound") == boundKinds.back();
  if (const int unknowns = list.get<int>("Coarser Start"); unknowns > 0)
    parameters.coarserFrom = unknowns;
  else
    parameters.coarserFrom = std::numeric_limits<GlobalOrdinal>::max();
  parameters.quantity = QuantityParameters::from(list.sublist("Quantity"));
  parameters.target = list.get<double>("Target");
  parameters.refinement = enumeratorFrom<Refinement>(list, "Refinement", refinements);
  parameters.order = list.get<int>("Order");
  if (parameters.refinement == Refinement::even && parameters.order != 0)
    throw InputError(
        "list \"Accuracy\" has an \"Order\", which goes with \"Refinement\" = \"local\" alone: \"even\" "
        "keeps the order that \"Bodies\" give; leave it out, or give the bodies' \"Order\"");
  parameters.maxLevels = list.get<int>("Maximum Levels");
  const auto limit = [&](const char* name) {
    const double value = list.get<double>(name);
    return value > 0 ? value : std::numeric_limits<double>::infinity();
  };
  parameters.maxUnknowns = limit("Maximum Unknowns");
  parameters.maxSeconds = limit("Maximum Seconds");
  constexpr double share = 0.8, giga = 1e9;
  const double memory = giga * list.get<double>("Maximum Memory");
  parameters.maxBytes = memory > 0 ? memory : share * freeBytes();
  return parameters;
}

} // namespace epafi::simulation
