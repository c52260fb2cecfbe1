#include "RefinementCosts.hpp"

#include "Median.hpp"
#include "epafi/simulation/AccurateRun.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace epafi::drivers {
namespace {

/// Runs longer than this are made once.
constexpr double longRun = 30;

struct Measured {
  simulation::SceneRun run;
  Row row;
};

/// A scene with all elements larger by a factor, and its bodies cut into grids or parts of a size that suits
/// them.
scene::Scene onEvenMesh(scene::Scene scene, int order, double size) {
  for (scene::Body& body : scene.bodies) {
    const bool isSolid = dimensionOf(body.physics) == 3;
    const double perSubdomain = isSolid ? 4.5 : 16; // nodes along an edge
    body.mesh.order = order;
    body.mesh.sizeFactor *= size;
    for (std::size_t k = 0; k < 3; ++k) {
      int& elements = body.mesh.elements[k];
      elements = static_cast<int>(std::lround(elements / size));
      body.decomposition.counts[k] =
          std::max(1, static_cast<int>(std::lround(order * elements / perSubdomain)));
    }
    body.decomposition.parts = 0; // as many as suit
  }
  return scene;
}

class Runs {
public:
  Runs(const std::string& name, const std::filesystem::path& scenes, RCP<const Comm> comm)
      : comm_(std::move(comm)) {
    const std::string file = (scenes / (name + ".xml")).string();
    const Teuchos::ParameterList given = scene::readParameterFile(file, *comm_);
    scene_ = scene::readScene(given, file);
    solver_ = validated(given, simulation::driverSchema(), file).sublist("Solver");
  }

  [[nodiscard]] Measured local(double target, int order) const {
    simulation::AccuracyParameters accuracy;
    accuracy.target = target;
    accuracy.order = order;
    simulation::AccurateRun result = simulation::solveToTarget(scene_, solver_, accuracy, comm_, nullptr, {});
    if (!result.loop.isMet)
      throw Error(scene_.title + ": " + result.run.result.reason);
    const int meshes = static_cast<int>(result.loop.meshes.size());
    return {std::move(result.run),
            {{"refinement", "local"},
             {"target", target},
             {"order", result.loop.meshes.back().order},
             {"meshes", meshes}}};
  }

  [[nodiscard]] Measured even(double size, int order) const {
    simulation::SceneRun run = simulation::solveScene(
        onEvenMesh(scene_, order, size), solver_, comm_,
        {.estimatesError = true, .facts = {.coarserFrom = simulation::AccuracyParameters().coarserFrom}});
    if (run.result.status != simulation::RunStatus::converged)
      throw Error(scene_.title + ": " + run.result.reason);
    return {std::move(run), {{"refinement", "even"}, {"size", size}, {"order", order}, {"meshes", 1}}};
  }

private:
  RCP<const Comm> comm_;
  scene::Scene scene_;
  Teuchos::ParameterList solver_;
};

/// What is known of a run, beside the reference.
void compare(Measured& measured, const simulation::SceneRun& reference) {
  const simulation::SceneRun& run = measured.run;
  Row& row = measured.row;
  const double own = reference.result.error->relative(), norm = reference.error->energyNorm;
  const double distance =
      accuracy::errorAgainst(reference.scene, *reference.decomposition, reference.solution.displacement,
                             *run.decomposition, run.solution.displacement)
          .energy;
  row["unknowns"] = static_cast<double>(run.decomposition->problem.primalDimension);
  row["estimated_error"] = run.result.error->relative();
  row["energy_error"] = std::hypot(distance / norm, own);
  row["energy"] = run.result.energy;
  row["energy_norm"] = std::hypot(norm, own * norm);
  row["reference_error"] = own;
  row["reference_unknowns"] = static_cast<double>(reference.decomposition->problem.primalDimension);
}

} // namespace

std::vector<Row> measureRefinement(const std::string& name, const Teuchos::ParameterList& list,
                                   const std::filesystem::path& scenes, const RCP<const Comm>& comm) {
  const Runs runs(name, scenes, comm);
  std::vector<std::function<Measured()>> work;
  for (const double target : list.get<Teuchos::Array<double>>("Targets"))
    work.emplace_back([&runs, target] { return runs.local(target, 0); });
  for (const int order : {1, 2})
    for (const double size : list.get<Teuchos::Array<double>>("Sizes"))
      work.emplace_back([&runs, size, order] { return runs.even(size, order); });
  const simulation::SceneRun reference = std::move(runs.local(list.get<double>("Reference"), 2).run);
  std::vector<Row> rows(work.size());
  std::vector<std::vector<double>> seconds(work.size());
  const int repeats = static_cast<int>(list.get<double>("Repeats"));
  for (int round = 0; round < repeats; ++round)
    for (std::size_t k = 0; k < work.size(); ++k) {
      if (round > 0 && seconds[k].front() > longRun)
        continue;
      const double start = Teuchos::Time::wallTime();
      Measured measured = work[k]();
      seconds[k].push_back(maxOverRanks(*comm, Teuchos::Time::wallTime() - start));
      if (round == 0) {
        compare(measured, reference);
        rows[k] = std::move(measured.row);
        rows[k]["problem"] = name;
        rows[k]["solver"] = "epafi";
      }
      rows[k]["seconds"] = median(seconds[k]);
    }
  return rows;
}

Table refinementTable() {
  return Table("problem,solver,order,refinement,unknowns,seconds,energy_error,target,size,meshes,estimated_"
               "error,energy,"
               "energy_norm,reference_error,reference_unknowns",
               12);
}

} // namespace epafi::drivers
