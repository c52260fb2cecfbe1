#include "AccuracyCase.hpp"

#include "AccurateRun.hpp"
#include "Median.hpp"

#include <cmath>
#include <sstream>
#include <utility>

namespace epafi::drivers {
namespace {

constexpr std::size_t mostRounds = 7;

/// One run with what it took.
struct TimedRun {
  SceneRun run;
  double seconds = 0;       ///< all meshes, without the estimate of the last one's error, which only reports
  double finestSeconds = 0; ///< likewise, on the last mesh
  double allProducts = 0;
};

/// From the scene to the solution. Balanced runs go the way of nested ones, on one mesh.
TimedRun timedRun(const AccuracyProblem& problem, int level, const AccuracyVariant& variant,
                  const RCP<const Comm>& comm) {
  const int coarsest = variant.isNested ? 0 : level;
  AccuracyParameters accuracy;
  accuracy.target = std::numeric_limits<double>::min(); // never met: all meshes that are allowed
  accuracy.maxLevels = level - coarsest + 1;
  accuracy.maxUnknowns = std::numeric_limits<double>::max();
  AccurateRun result =
      solveToTarget(problem.onMesh(coarsest), variant.parameters(), accuracy, comm, nullptr, {});
  TimedRun timed;
  const double lastEstimate = result.run.report.sublist("Time").get<double>("Error Estimate");
  for (const Level& one : result.levels) {
    timed.seconds += one.seconds;
    timed.allProducts += one.multiplications * static_cast<double>(one.unknowns) /
                         static_cast<double>(result.levels.back().unknowns);
  }
  timed.seconds -= lastEstimate;
  timed.finestSeconds = result.levels.back().seconds - lastEstimate;
  timed.run = std::move(result.run);
  return timed;
}

/// Both run on the same mesh, cut alike.
accuracy::ErrorNorms algebraicError(const SceneRun& run, const SceneRun& tight) {
  std::vector<Eigen::VectorXd> difference = run.solution.displacement;
  for (std::size_t s = 0; s < difference.size(); ++s)
    difference[s] -= tight.solution.displacement[s];
  return accuracy::errorNorms(run.scene, *run.decomposition, difference, {});
}

double relativeDistance(double value, double exact) {
  return exact != 0 ? std::abs(value / exact - 1) : std::abs(value);
}

/// All of a row but times.
AccuracyRow errorsOf(const TimedRun& timed, const AccuracyReference& reference, const TightSolution& tight) {
  const SceneRun& run = timed.run;
  const accuracy::ErrorNorms& norms = reference.norms();
  const accuracy::ErrorNorms algebraic = algebraicError(run, tight.run);
  const ContactResult contact = contactOf(run);
  AccuracyRow row;
  row.status = qp::toString(run.solver->report().status);
  row.elements = elementsOfSide(run.scene);
  row.unknowns = static_cast<double>(run.decomposition->problem.primalDimension);
  row.products = run.solver->report().counts.hessianMultiplications;
  row.allProducts = timed.allProducts;
  row.algebraicError = algebraic.energy / norms.energy;
  row.discretisationError = tight.error.energy / norms.energy;
  row.energyError = std::hypot(row.algebraicError, row.discretisationError);
  row.l2Error = std::hypot(algebraic.l2, tight.error.l2) / norms.l2;
  row.zoneError = relativeDistance(contact.area, reference.contact().area);
  row.forceError = relativeDistance(contact.force, reference.contact().force);
  row.estimatedError = run.relativeError();
  row.estimatedDiscretisation = run.error->discretisation / norms.energy;
  row.estimatedAlgebraic = run.solution.algebraicError / norms.energy;
  return row;
}

struct Times {
  std::vector<double> all, finest, solve;
};

std::string inWords(double tolerance) {
  std::ostringstream text;
  text << tolerance;
  return text.str();
}

} // namespace

Teuchos::ParameterList AccuracyVariant::parameters() const {
  Teuchos::ParameterList list;
  if (tolerance == "balanced") {
    list.set("Tolerance", tolerance);
  } else {
    const double value =
        tolerance.empty() ? ContactSolver(Teuchos::ParameterList()).tolerance() : std::stod(tolerance);
    list.set("Tolerance", value); // also the default: a run to a target would take another one
    if (!tolerance.empty())
      list.set("Equilibrium Tolerance", value);
  }
  if (!preconditioner.empty())
    list.sublist("Preconditioner").set("Type", preconditioner);
  if (!precision.empty())
    list.sublist("Preconditioner").set("Precision", precision);
  if (!dualOperator.empty())
    list.sublist("Dual Operator").set("Mode", dualOperator);
  return list;
}

std::string AccuracyVariant::toleranceInWords() const {
  return tolerance.empty() ? inWords(ContactSolver(Teuchos::ParameterList()).tolerance()) : tolerance;
}

std::vector<AccuracyVariant> variantsOnMeshes() {
  return {{"default", "", "", "", "", false},
          {"plain", "", "none", "", "", false},
          {"lumped", "", "lumped", "", "", false},
          {"implicit", "", "", "", "implicit", false},
          {"explicit", "", "", "", "explicit", false},
          {"single", "", "", "single", "", false},
          {"tolerance_1e-2", "1e-2", "", "", "", false},
          {"tolerance_1e-4", "1e-4", "", "", "", false},
          {"tolerance_1e-10", "1e-10", "", "", "", false},
          {"balanced", "balanced", "", "", "", false},
          {"nested", "balanced", "", "", "", true}};
}

std::vector<AccuracyVariant> variantsOfTolerance(bool quick) {
  std::vector<AccuracyVariant> variants;
  for (const auto& [name, type, precision] : {std::array{"plain", "none", "double"},
                                              {"lumped", "lumped", "double"},
                                              {"dirichlet", "dirichlet", "double"},
                                              {"single", "dirichlet", "single"}})
    for (int digits = 1; digits <= 10; digits += quick ? 3 : 1) {
      std::ostringstream tolerance;
      tolerance << "1e-" << digits;
      variants.push_back({std::string(ladderName) + name, tolerance.str(), type, precision, "", false});
    }
  return variants;
}

std::vector<AccuracyRow> measureVariants(const AccuracyProblem& problem, int level,
                                         const AccuracyReference& reference,
                                         const std::vector<AccuracyVariant>& variants, double budget,
                                         const RCP<const Comm>& comm) {
  std::vector<AccuracyRow> rows(variants.size());
  std::vector<Times> times(variants.size());
  double spent = 0;
  for (std::size_t round = 0; round == 0 || (round < mostRounds && spent < budget); ++round)
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const TimedRun timed = timedRun(problem, level, variants[v], comm);
      if (round == 0)
        rows[v] = errorsOf(timed, reference, reference.tight(level));
      times[v].all.push_back(timed.seconds);
      times[v].finest.push_back(timed.finestSeconds);
      times[v].solve.push_back(timed.run.report.sublist("Time").get<double>("Solve"));
      spent += timed.seconds; // the same on all ranks
    }
  for (std::size_t v = 0; v < variants.size(); ++v) {
    rows[v].problem = problem.name;
    rows[v].variant = variants[v].name;
    rows[v].tolerance = variants[v].toleranceInWords();
    rows[v].seconds = median(times[v].all);
    rows[v].finestSeconds = median(times[v].finest);
    rows[v].solveSeconds = median(times[v].solve);
    rows[v].repeats = static_cast<int>(times[v].all.size());
  }
  return rows;
}

} // namespace epafi::drivers
