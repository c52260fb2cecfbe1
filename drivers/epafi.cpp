/// `epafi SCENE.xml`: one contact problem from its XML scene to fields, report and exit code.

#include "AssemblyFiles.hpp"
#include "DeckFiles.hpp"
#include "JointEnd.hpp"
#include "Options.hpp"
#include "RunFiles.hpp"
#include "RunWatch.hpp"
#include "StopSignals.hpp"
#include "Summary.hpp"
#include "Task.hpp"

#include "epafi/assembly/AssemblySchema.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Version.hpp"
#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <string>

namespace {

using namespace epafi;
using namespace epafi::drivers;

/// What is printed instead of solving.
std::string information(const Options& options) {
  if (options.help)
    return usage();
  if (options.version)
    return std::string("epafi ") + version() + '\n';
  return describeParameters(assembly::withAssembly(simulation::driverSchema()),
                            "All parameters of a scene file with type, default, allowed values and meaning, "
                            "as `epafi --print-parameters` prints them.");
}

/// How to go on after a signal.
std::string farewell(const std::string& signal, const RunWatch& watch) {
  const std::string file = watch.checkpoint().string();
  return "  stopped     by " + signal +
         (file.empty() ? ", without a checkpoint: that takes --output\n"
                       : "; to go on: --restart " + file + '\n');
}

/// Whether the standard output took the text, or nobody wanted to read it; says so if not: a disk may be
/// full.
bool print(const std::string& text) {
  std::cout.clear(); // what was lost before, lines about progress, is no matter
  errno = 0;
  std::cout << text << std::flush;
  if (std::cout || errno == EPIPE)
    return true;
  std::cerr << "epafi: the results could not be written to the standard output: " << std::strerror(errno)
            << "; check the free space where it leads.\n";
  return false;
}

simulation::SceneRun solveAsAsked(const Task& task, const RCP<const Comm>& comm, RunWatch& watch,
                                  RunFiles& files, bool speaks) {
  const auto tell = [&](simulation::SceneRun& run, const auto& stage) {
    files.writeStage(run);
    if (speaks) // of a stage whose files are there
      std::cout << describe(stage) << std::flush;
  };
  const bool isSeries = refines(task, *comm);
  if (isSeries)
    watch.expectSeries();
  watch.expectSteps(task);
  files.goOn();
  if (const simulation::StepsDone* const done = watch.stepsDone(); done != nullptr && speaks)
    std::cout << "  restart     after step " << done->results.back().name << ", " << done->results.size()
              << " of " << task.steps.size() << '\n'
              << std::flush;
  simulation::SceneRun run =
      solveTask(task, comm, &watch,
                {.mesh = [&](const accuracy::MeshResult& mesh, auto& stage) { tell(stage, mesh); },
                 .step = [&](simulation::SceneRun& stage) { tell(stage, stage.result.steps.back()); }});
  if (isSeries && watch.restarts() && speaks)
    std::cout << "  restart     the checkpoint belongs to none of these meshes: all was done anew\n";
  return run;
}

/// Better now than after an hour. Collective.
void requireTargets(const Options& options, const Comm& comm) {
  std::vector<std::filesystem::path> files = reportsOf(options);
  for (const std::string& file : {options.frd, options.dat})
    if (!file.empty())
      files.emplace_back(file);
  for (const auto& file : files) {
    collectively(comm, [&] {
      std::error_code ignored;
      for (const std::string& input : {options.scene, options.completion, options.restart})
        if (std::filesystem::equivalent(file, input, ignored))
          throw InputError("the file " + file.string() +
                           " would overwrite what is read; choose another name");
    });
    output::prepareTarget(file, comm);
  }
}

int solve(const Options& options, const RCP<const Comm>& comm) {
  const bool speaks = comm->getRank() == 0 && !options.quiet;
  const double start = Teuchos::Time::wallTime();
  const auto [given, notes] = readGiven(options, *comm);
  Task task = readTask(given, options.scene);
  task.keepsMesh = !options.dat.empty(); // which has the deck's own nodes and elements
  const std::string& title = task.scene.title;
  if (!options.frd.empty())
    output::requireElasticBodies(task.scene, options.scene + ", option --frd");
  requireTargets(options, *comm);
  if (speaks)
    std::cout << "Epafi " << version() << ": " << (title.empty() ? options.scene : title) << '\n'
              << notes << std::flush;

  RunWatch watch(options, comm);
  RunFiles files(options, watch, comm, start, notes);
  simulation::SceneRun run = solveAsAsked(task, comm, watch, files, speaks);
  const bool isInterrupted = run.result.status == simulation::RunStatus::interrupted;
  const std::string signal = isInterrupted ? watch.signal() : "";
  files.finish(run);
  bool isComplete = run.result.status == simulation::RunStatus::converged && files.failures().empty();
  if (speaks && !print(summary(run.result) + files.lines() + (isInterrupted ? farewell(signal, watch) : "")))
    isComplete = false;
  for (const std::string& failure : files.failures())
    if (comm->getRank() == 0)
      std::cerr << "epafi: " << failure << '\n';
  return isComplete ? solved : notConverged;
}

/// What is written or printed of a model that is not solved.
int tellOf(const Options& options, const RCP<const Comm>& comm) {
  if (!options.show.empty())
    showFaces(options, comm);
  if (!options.exported.empty() && meshing::isStep(options.scene))
    exportAssembly(options, comm);
  else if (!options.exported.empty())
    exportDeck(options.scene, options.exported, comm);
  if (!options.list && !options.printPairs)
    return solved;
  const std::string text = listOf(options, *comm);
  return comm->getRank() > 0 || print(text) ? solved : notConverged;
}

int run(int argc, char** argv, const RCP<const Comm>& comm) {
  const Options options = parseOptions(argc, argv);
  if (options.help || options.version || options.printParameters)
    return comm->getRank() > 0 || print(information(options)) ? solved : notConverged;
  const bool isSolved =
      options.show.empty() && options.exported.empty() && !options.list && !options.printPairs;
  return isSolved ? solve(options, comm) : tellOf(options, comm);
}

} // namespace

int main(int argc, char** argv) {
  return runMain(argc, argv, "epafi", [&](const RCP<const Comm>& comm) {
    listenToStopSignals();
    return run(argc, argv, comm);
  });
}
