#include "Effectivity.hpp"

#include "AccuracyReference.hpp"

#include "epafi/accuracy/Refinement.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace epafi::drivers {
namespace {

scene::Scene readNamed(const std::string& name, const std::filesystem::path& scenes, const Comm& comm) {
  const std::string file = (scenes / (name + ".xml")).string();
  return scene::readScene(scene::readParameterFile(file, comm), file);
}

} // namespace

std::vector<EffectivityCase> effectivityCases(bool quick) {
  if (quick)
    return {{"coercive"}, {"semicoercive"}};
  return {{"coercive"},       {"semicoercive"},        {"three_bodies"}, {"gap"},
          {"hertz_cylinder"}, {"pressed_ring"},        {"punch"},        {"stacked_blocks", 1},
          {"three_cubes", 2}, {"hertz_sphere", 1, 2.0}};
}

std::vector<EffectivityRow> measureEffectivity(const EffectivityCase& which,
                                               const std::filesystem::path& scenes,
                                               const RCP<const Comm>& comm) {
  scene::Scene scene = readNamed(which.scene, scenes, *comm);
  for (scene::Body& body : scene.bodies)
    if (body.solid)
      body.solid->mesh.sizeFactor *= which.meshSize;
  std::vector<SceneRun> runs;
  runs.reserve(static_cast<std::size_t>(which.refinements) + 1);
  for (int level = 0; level <= which.refinements; ++level) {
    runs.push_back(solveTightly(scene, level > 0 ? &runs.back() : nullptr, comm));
    scene = accuracy::refined(std::move(scene));
  }
  const SceneRun& reference = runs.back();
  std::vector<double> distances; // from coarse to fine, without the reference itself
  for (int level = 0; level < which.refinements; ++level)
    distances.push_back(accuracy::errorAgainst(reference.scene, *reference.decomposition,
                                               reference.solution.displacement,
                                               *runs[static_cast<std::size_t>(level)].decomposition,
                                               runs[static_cast<std::size_t>(level)].solution.displacement)
                            .energy);
  const double own = which.refinements > 1
                         ? referenceError(distances[distances.size() - 1], distances[distances.size() - 2])
                         : distances.back() / std::sqrt(3.0); // as errors of order h are
  std::vector<EffectivityRow> rows;
  for (int level = 0; level < which.refinements; ++level) {
    const SceneRun& run = runs[static_cast<std::size_t>(level)];
    const double norm = reference.error->energyNorm;
    EffectivityRow row;
    row.scene = which.scene;
    row.level = level;
    row.unknowns = static_cast<double>(run.decomposition->problem.primalDimension);
    row.estimated = run.error->discretisation / norm;
    row.error = std::hypot(distances[static_cast<std::size_t>(level)], own) / norm;
    row.referenceUnknowns = static_cast<double>(reference.decomposition->problem.primalDimension);
    row.referenceError = own / norm;
    rows.push_back(row);
  }
  return rows;
}

std::string effectivityCsv(const std::vector<EffectivityRow>& rows) {
  std::ostringstream text;
  text << "scene,level,unknowns,estimated_error,discretisation_error,effectivity,reference_unknowns,"
          "reference_error\n";
  for (const EffectivityRow& row : rows)
    text << row.scene << ',' << row.level << ',' << row.unknowns << ',' << row.estimated << ',' << row.error
         << ',' << row.effectivity() << ',' << row.referenceUnknowns << ',' << row.referenceError << '\n';
  return text.str();
}

std::string effectivityReport(const std::vector<EffectivityRow>& rows) {
  // Below this a mesh has no error of its own, and the quotient is that of round-off.
  constexpr double noError = 1e-8;
  std::ostringstream text;
  text << "| scene | mesh | unknowns | estimated error | error | effectivity | unknowns of the reference | "
          "its own "
          "error |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n"
       << std::setprecision(3);
  for (const EffectivityRow& row : rows) {
    text << "| " << row.scene << " | " << (row.level == 0 ? "its own" : "refined once") << " | "
         << std::llround(row.unknowns) << " | " << 100 * row.estimated << " % | " << 100 * row.error
         << " % | ";
    if (row.error > noError)
      text << row.effectivity();
    else
      text << "no error";
    text << " | " << std::llround(row.referenceUnknowns) << " | " << 100 * row.referenceError << " % |\n";
  }
  return text.str();
}

} // namespace epafi::drivers
