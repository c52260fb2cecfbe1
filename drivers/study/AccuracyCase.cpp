#include "AccuracyCase.hpp"

#include "Median.hpp"
#include "epafi/simulation/AccurateRun.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace epafi::drivers {
namespace {

constexpr std::size_t mostRounds = 7;

/// One run with what it took.
struct TimedRun {
  simulation::SceneRun run;
  double seconds = 0;       ///< all meshes, estimates of their errors included
  double finestSeconds = 0; ///< likewise, on the last mesh
  double allProducts = 0;
};

/// In words.
std::string toleranceOf(const Case& variant) {
  return variant.parameter.empty() ? plain(ContactSolver(Teuchos::ParameterList()).plan().tolerance)
                                   : variant.parameter;
}

/// The list Solver.
Teuchos::ParameterList parametersOf(const Case& variant) {
  Teuchos::ParameterList list;
  if (variant.list.isSublist("Solver"))
    list = variant.list.sublist("Solver");
  if (variant.parameter == "balanced")
    return list.set("Tolerance", variant.parameter);
  const double tolerance = std::stod(toleranceOf(variant));
  list.set("Tolerance", tolerance); // also the default: a run to a target would take another one
  if (!variant.parameter.empty())
    list.set("Equilibrium Tolerance", tolerance);
  return list;
}

/// From the scene to the solution. Balanced runs go the way of nested ones, on one mesh.
TimedRun timedRun(const AccuracyProblem& problem, int level, const Case& variant,
                  const RCP<const Comm>& comm) {
  const int coarsest = variant.list.isParameter("Nested") ? 0 : level;
  simulation::AccuracyParameters accuracy;
  accuracy.target = std::numeric_limits<double>::min(); // never met: all meshes that are allowed
  accuracy.maxLevels = level - coarsest + 1;
  accuracy.refinement = simulation::AccuracyParameters::Refinement::even;
  simulation::AccurateRun result =
      simulation::solveToTarget(problem.onMesh(coarsest), parametersOf(variant), accuracy, comm, nullptr, {});
  TimedRun timed;
  for (const accuracy::MeshResult& one : result.loop.meshes) {
    timed.seconds += one.seconds;
    timed.allProducts += one.multiplications * static_cast<double>(one.unknowns) /
                         static_cast<double>(result.loop.meshes.back().unknowns);
  }
  timed.finestSeconds = result.loop.meshes.back().seconds;
  timed.run = std::move(result.run);
  return timed;
}

/// Both run on the same mesh, cut alike.
accuracy::ErrorNorms algebraicError(const simulation::SceneRun& run, const simulation::SceneRun& tight) {
  std::vector<Eigen::VectorXd> difference = run.solution.displacement;
  for (std::size_t s = 0; s < difference.size(); ++s)
    difference[s] -= tight.solution.displacement[s];
  return accuracy::errorNorms(run.scene, *run.decomposition, difference, {});
}

double relativeDistance(double value, double exact) {
  return exact != 0 ? std::abs(value / exact - 1) : std::abs(value);
}

/// All of a row but times.
Row errorsOf(const TimedRun& timed, const AccuracyReference& reference, const TightSolution& tight) {
  const simulation::SceneRun& run = timed.run;
  const accuracy::ErrorNorms& norms = reference.norms();
  const accuracy::ErrorNorms algebraic = algebraicError(run, tight.run);
  const ContactResult contact = contactOf(run);
  const double iteration = algebraic.energy / norms.energy, mesh = tight.error.energy / norms.energy;
  return {{"status", qp::toString(run.solver->report().status)},
          {"order", run.scene.bodies.front().mesh.order},
          {"elements", elementsOfSide(run.scene)},
          {"unknowns", static_cast<double>(run.decomposition->problem.primalDimension)},
          {"hessian_multiplications", run.solver->report().counts.hessianMultiplications},
          {"all_multiplications", timed.allProducts},
          {"algebraic_error", iteration},
          {"discretisation_error", mesh},
          {"energy_error", std::hypot(iteration, mesh)},
          {"l2_error", std::hypot(algebraic.l2, tight.error.l2) / norms.l2},
          {"contact_zone_error", relativeDistance(contact.area, reference.contact().area)},
          {"force_error", relativeDistance(contact.force, reference.contact().force)},
          {"estimated_error", run.result.error->relative()},
          {"estimated_discretisation_error", run.error->discretisation / norms.energy},
          {"estimated_algebraic_error", run.solution.algebraicError / norms.energy}};
}

struct Times {
  std::vector<double> all, finest, solve;
};

} // namespace

std::vector<Row> measureVariants(const AccuracyProblem& problem, int level,
                                 const AccuracyReference& reference, const std::vector<Case>& variants,
                                 double budget, const RCP<const Comm>& comm) {
  std::vector<Row> rows(variants.size());
  std::vector<Times> times(variants.size());
  double spent = 0;
  for (std::size_t round = 0; round == 0 || (round < mostRounds && spent < budget); ++round)
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const TimedRun timed = timedRun(problem, level, variants[v], comm);
      if (round == 0)
        rows[v] = errorsOf(timed, reference, reference.tight(level));
      times[v].all.push_back(timed.seconds);
      times[v].finest.push_back(timed.finestSeconds);
      times[v].solve.push_back(timed.run.result.solve.times.solve);
      spent += timed.seconds; // the same on all ranks
    }
  for (std::size_t v = 0; v < variants.size(); ++v) {
    rows[v]["problem"] = problem.name;
    rows[v]["variant"] = variants[v].name;
    rows[v]["tolerance"] = toleranceOf(variants[v]);
    rows[v]["seconds"] = median(times[v].all);
    rows[v]["finest_seconds"] = median(times[v].finest);
    rows[v]["solve_seconds"] = median(times[v].solve);
    rows[v]["repeats"] = times[v].all.size();
    addDigits(rows[v]);
  }
  return rows;
}

} // namespace epafi::drivers
