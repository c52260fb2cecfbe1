#include "AccuracyTargets.hpp"

#include "epafi/simulation/AccurateRun.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <cmath>
#include <numeric>

namespace epafi::drivers {

std::vector<Row> measureTargets(const std::string& name, int order, const std::vector<double>& targets,
                                double reference, const std::filesystem::path& scenes,
                                const RCP<const Comm>& comm) {
  const std::string file = (scenes / (name + ".xml")).string();
  const Teuchos::ParameterList given = scene::readParameterFile(file, *comm);
  const scene::Scene scene = scene::readScene(given, file);
  const Teuchos::ParameterList complete = validated(given, simulation::driverSchema(), file);
  const Teuchos::ParameterList solver = complete.sublist("Solver");
  const auto solve = [&](double target, int elements) {
    // memory free now
    simulation::AccuracyParameters accuracy =
        simulation::AccuracyParameters::from(complete.sublist("Accuracy"));
    accuracy.target = target;
    accuracy.order = elements;
    return simulation::solveToTarget(scene, solver, accuracy, comm, nullptr, {});
  };
  const simulation::AccurateRun best = solve(reference, 2);
  const double norm = best.run.error->energyNorm;
  std::vector<Row> rows;
  for (const double target : targets) {
    const simulation::AccurateRun result = solve(target, order);
    const std::vector<accuracy::MeshResult>& meshes = result.loop.meshes;
    if (best.loop.meshes.back().relative() > 0.7 * meshes.back().relative())
      continue; // memory has kept the reference as coarse as that
    const double error =
        accuracy::errorAgainst(best.run.scene, *best.run.decomposition, best.run.solution.displacement,
                               *result.run.decomposition, result.run.solution.displacement)
            .energy /
        norm;
    rows.push_back({{"scene", name},
                    {"order", meshes.back().order},
                    {"target", target},
                    {"met", result.loop.isMet ? 1 : 0},
                    {"meshes", static_cast<int>(meshes.size())},
                    {"unknowns", meshes.back().unknowns},
                    {"seconds", std::accumulate(meshes.begin(), meshes.end(), 0.0,
                                                [](double sum, const accuracy::MeshResult& mesh) {
                                                  return sum + mesh.seconds;
                                                })},
                    {"last_seconds", meshes.back().seconds},
                    {"estimated_error", meshes.back().relative()},
                    {"true_error", error},
                    {"effectivity", meshes.back().relative() / error},
                    {"reference_unknowns", best.loop.meshes.back().unknowns},
                    {"reference_error", best.loop.meshes.back().relative()}});
  }
  return rows;
}

double fittedOrder(const std::vector<Row>& rows) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Row& row : rows) {
    const double unknowns = std::log(row.number("unknowns")), error = std::log(row.number("true_error"));
    n += 1;
    x += unknowns;
    y += error;
    xx += unknowns * unknowns;
    xy += unknowns * error;
  }
  return (x * y - n * xy) / (n * xx - x * x);
}

Table targetsTable() {
  return Table("scene,order,target,met,meshes,unknowns,seconds,last_seconds,estimated_error,true_error,"
               "effectivity,reference_unknowns,reference_error");
}

std::string targetsReport(const Table& table) {
  const auto percent = [](double share) { return plain(100 * share, 3) + " %"; };
  std::string text =
      markdownHeading("scene | order | target | meshes | unknowns | seconds | of the last mesh | "
                      "estimated error | error | effectivity");
  for (const Row& row : table.rows)
    text += markdownLine({row.text("scene"), row.text("order"), percent(row.number("target")),
                          row.text("meshes"), count(row.number("unknowns")), plain(row.number("seconds"), 3),
                          plain(row.number("last_seconds"), 3), percent(row.number("estimated_error")),
                          percent(row.number("true_error")), plain(row.number("effectivity"), 3)});
  text += "\nError ~ N^-s, fitted over the targets:\n\n" + markdownHeading("scene | order | s");
  for (std::size_t first = 0; first < table.rows.size();) {
    std::vector<Row> series;
    while (first < table.rows.size() &&
           (series.empty() || table.rows[first].isLike(series.front(), {"scene", "order"})))
      series.push_back(table.rows[first++]);
    if (series.size() > 2)
      text += markdownLine(
          {series.front().text("scene"), series.front().text("order"), plain(fittedOrder(series), 3)});
  }
  return text;
}

} // namespace epafi::drivers
