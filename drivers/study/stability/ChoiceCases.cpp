/// Parameters of the algorithms far from their defaults, estimates of ‖F‖ that are wrong, and tolerances at round-off.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

std::string words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0e", value);
  return text;
}

void add(StabilityCases& cases, const std::string& name, const std::string& parameter, double value,
         const Expectation& expected, const ContactTask& task) {
  for (const bool isPlain : {false, true}) {
    ContactTask mine = task;
    if (isPlain)
      mine.solver.setParameters(plainMethod());
    StabilityCase trial{"choices", name, parameter, expected, {}};
    trial.run = [mine](const RCP<const Comm>& comm) { return solveContact(mine, comm); };
    trial.value = value;
    trial.variant = isPlain ? "plain" : "default";
    cases.push_back(std::move(trial));
  }
}

/// One real parameter of one sublist, over six orders.
void scan(StabilityCases& cases, const std::string& name, const std::string& list,
          const std::string& parameter, bool coercive, bool quick) {
  for (int k = -3; k <= 3; k += quick ? 3 : 1) {
    ContactTask task{membranes(coercive, 2, quick ? 4 : 8)};
    const double value = std::pow(10.0, k);
    task.solver.sublist(list).set(parameter, value);
    add(cases, name, words(value), value, solved(), task);
  }
}

/// ᾱ and the estimate that it comes from.
void addNorms(StabilityCases& cases, bool quick) {
  for (const bool coercive : {true, false}) {
    const std::string which = coercive ? "" : ", floating";
    const scene::Scene scene = membranes(coercive, 2, quick ? 4 : 8);
    for (const char* method : {"power", "lanczos"})
      for (const int products : {1, 3}) {
        ContactTask task{scene};
        task.solver.sublist("Norm Estimate")
            .set("Method", method)
            .set("Maximum Iterations", products)
            .set("Safety", 1.0);
        task.solver.sublist("MPRGP").set("Expansion", "fixed step");
        add(cases, "norm estimate from few products" + which, method + (", " + std::to_string(products)),
            products, solved(), task);
      }
    ContactTask task{scene};
    task.solver.sublist("Norm Estimate").set("Safety", 100.0);
    task.solver.sublist("MPRGP").set("Expansion", "fixed step");
    add(cases, "norm estimate too large" + which, "by 100", 100, solved(), task);
    for (const double step : {1e-3, 1e-1, 1.0, 1.999}) {
      ContactTask stepping{scene};
      stepping.solver.sublist("MPRGP").set("Expansion", "fixed step").set("Expansion Step", step);
      add(cases, "step length of expansions" + which, words(step), step, solved(), stepping);
    }
  }
}

/// Below round-off nothing is promised but the truth.
void addTolerances(StabilityCases& cases, bool quick) {
  for (int k = 10; k <= 16; k += quick ? 3 : 1) {
    const double tolerance = std::pow(10.0, -k);
    const Expectation expected = k <= 11 ? solved() : solvedOrStopped();
    const auto task = [&](const scene::Scene& scene) {
      ContactTask result{scene};
      result.tolerance = tolerance;
      return result;
    };
    add(cases, "tolerance", words(tolerance), tolerance, expected, task(membranes(true, 2, 4)));
    add(cases, "tolerance, floating", words(tolerance), tolerance, expected, task(membranes(false, 2, 4)));
    add(cases, "tolerance, elastic", words(tolerance), tolerance, expected, task(pressedSquares(2, 3)));
  }
}

} // namespace

StabilityCases choiceCases(bool quick) {
  StabilityCases cases;
  scan(cases, "proportioning constant", "MPRGP", "Proportioning Constant", true, quick);
  scan(cases, "proportioning constant, floating", "MPRGP", "Proportioning Constant", false, quick);
  scan(cases, "penalty", "SMALBE", "Penalty", false, quick);
  scan(cases, "balance", "SMALBE", "Balance", false, quick);
  addNorms(cases, quick);
  addTolerances(cases, quick);
  return cases;
}

} // namespace epafi::drivers
