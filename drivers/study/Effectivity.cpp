#include "Effectivity.hpp"

#include "AccuracyReference.hpp"

#include "epafi/accuracy/Refinement.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"
#include "epafi/simulation/AccurateRun.hpp"

#include <cmath>
#include <utility>

namespace epafi::drivers {

namespace {

/// The last mesh of a run to a target.
simulation::SceneRun finest(const scene::Scene& scene, const Teuchos::ParameterList& given, double target,
                            const RCP<const Comm>& comm) {
  const Teuchos::ParameterList complete = validated(given, simulation::driverSchema(), scene.title);
  simulation::AccuracyParameters accuracy =
      simulation::AccuracyParameters::from(complete.sublist("Accuracy"));
  accuracy.target = target;
  accuracy.order = 2;
  return simulation::solveToTarget(scene, complete.sublist("Solver"), accuracy, comm, nullptr, {}).run;
}

} // namespace

std::vector<Row> measureEffectivity(const std::string& name, double target, double meshSize,
                                    const std::filesystem::path& scenes, const RCP<const Comm>& comm) {
  const std::string file = (scenes / (name + ".xml")).string();
  const Teuchos::ParameterList given = scene::readParameterFile(file, *comm);
  scene::Scene scene = scene::readScene(given, file);
  for (scene::Body& body : scene.bodies)
    body.mesh.sizeFactor *= meshSize;
  const int levels = target > 0 ? 1 : 2;
  std::vector<simulation::SceneRun> runs;
  runs.reserve(static_cast<std::size_t>(levels) + 1);
  for (int level = 0; level < (target > 0 ? 1 : 3); ++level) {
    runs.push_back(solveTightly(scene, level > 0 ? &runs.back() : nullptr, comm));
    if (target == 0)
      scene = accuracy::refined(std::move(scene));
  }
  if (target > 0)
    runs.push_back(finest(scene, given, target, comm));
  const simulation::SceneRun& reference = runs.back();
  std::vector<double> distances; // from coarse to fine, without the reference itself
  for (int level = 0; level < levels; ++level)
    distances.push_back(accuracy::errorAgainst(reference.scene, *reference.decomposition,
                                               reference.solution.displacement, *runs[level].decomposition,
                                               runs[level].solution.displacement)
                            .energy);
  const double own = target > 0
                         ? reference.error->discretisation
                         : referenceError(distances[distances.size() - 1], distances[distances.size() - 2]);
  std::vector<Row> rows;
  for (int level = 0; level < levels; ++level) {
    const simulation::SceneRun& run = runs[level];
    const double norm = reference.error->energyNorm, estimated = run.error->discretisation / norm,
                 error = std::hypot(distances[level], own) / norm;
    rows.push_back(
        {{"scene", name},
         {"level", level},
         {"unknowns", static_cast<double>(run.decomposition->problem.primalDimension)},
         {"estimated_error", estimated},
         {"discretisation_error", error},
         {"effectivity", estimated / error},
         {"reference_unknowns", static_cast<double>(reference.decomposition->problem.primalDimension)},
         {"reference_error", own / norm}});
  }
  return rows;
}

Table effectivityTable() {
  return Table("scene,level,unknowns,estimated_error,discretisation_error,effectivity,reference_unknowns,"
               "reference_error");
}

std::string effectivityReport(const Table& table) {
  // Below this a mesh has no error of its own, and the quotient is that of round-off.
  constexpr double noError = 1e-8;
  const auto percent = [](double share) { return plain(100 * share, 3) + " %"; };
  std::string text =
      markdownHeading("scene | mesh | unknowns | estimated error | error | effectivity | unknowns of the "
                      "reference | its own error");
  for (const Row& row : table.rows)
    text += markdownLine(
        {row.text("scene"), row.number("level") == 0 ? "its own" : "refined once",
         count(row.number("unknowns")), percent(row.number("estimated_error")),
         percent(row.number("discretisation_error")),
         row.number("discretisation_error") > noError ? plain(row.number("effectivity"), 3) : "no error",
         count(row.number("reference_unknowns")), percent(row.number("reference_error"))});
  return text;
}

} // namespace epafi::drivers
