/// `epafi SCENE.xml`: one contact problem from its XML scene to fields, report and exit code.

#include "Options.hpp"
#include "Progress.hpp"
#include "SceneRun.hpp"
#include "Summary.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/FieldWriter.hpp"
#include "epafi/output/HistoryTable.hpp"
#include "epafi/output/Report.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/ParameterOverride.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>
#include <Tpetra_Core.hpp>

#include <iostream>
#include <optional>
#include <vector>

namespace {

using namespace epafi;
using namespace epafi::drivers;

enum ExitCode : int { solved = 0, notConverged = 1, wrongInput = 2, notSolvable = 3 };

/// DIR/report.xml and the file of --report, as far as they were asked for; not twice the same.
std::vector<std::filesystem::path> reportsOf(const Options& options) {
  std::vector<std::filesystem::path> files;
  if (!options.output.empty())
    files.push_back(std::filesystem::path(options.output) / "report.xml");
  if (!options.report.empty() &&
      (files.empty() ||
       files[0].lexically_normal() != std::filesystem::path(options.report).lexically_normal()))
    files.emplace_back(options.report);
  return files;
}

/// What is printed instead of solving.
std::string information(const Options& options) {
  if (options.help)
    return usage();
  if (options.version)
    return "epafi " EPAFI_VERSION "\n";
  return describeParameters(driverSchema(),
                            "All parameters of a scene file with type, default, allowed values and meaning, "
                            "as `epafi --print-parameters` prints them.");
}

/// Writes what was asked for; returns the lines that say where.
std::string writeFiles(const Options& options, SceneRun& run, const Comm& comm) {
  std::string lines;
  const double start = Teuchos::Time::wallTime();
  const std::filesystem::path directory = options.output;
  if (!options.output.empty()) {
    const std::string name = std::filesystem::path(options.scene).stem().string();
    const auto files =
        output::writeFields(directory, name, run.solved(), run.evaluation, run.solver->report().history);
    output::writeHistory(run.solver->report().history, directory / "history.csv", comm);
    lines += "  fields      " + files.hdf5.string() + " and " + files.xdmf.string() + "\n  history     " +
             (directory / "history.csv").string() + "\n";
  }
  const double now = Teuchos::Time::wallTime();
  run.report.sublist("Time").set("Output", maxOverRanks(comm, now - start));
  run.report.sublist("Time").set("Total", maxOverRanks(comm, now - run.started));
  for (const std::filesystem::path& file : reportsOf(options)) {
    output::writeReport(run.report, file, comm);
    lines += "  report      " + file.string() + "\n";
  }
  return lines;
}

int solve(const Options& options, const RCP<const Comm>& comm) {
  const bool speaks = comm->getRank() == 0 && !options.quiet;
  const double start = Teuchos::Time::wallTime();
  Teuchos::ParameterList given = scene::readParameterFile(options.scene, *comm);
  const Teuchos::ParameterList schema = driverSchema();
  for (const std::string& text : options.overrides)
    scene::applyOverride(given, schema, text);
  const Teuchos::ParameterList list = validated(given, schema, options.scene);
  const scene::Scene scene = scene::readScene(given, options.scene);
  for (const auto& file : reportsOf(options)) {
    collectively(*comm, [&] {
      std::error_code ignored;
      if (std::filesystem::equivalent(file, options.scene, ignored))
        throw InputError("the report " + file.string() + " would overwrite the scene; choose another name");
    });
    output::prepareTarget(file, *comm); // better now than after an hour
  }
  if (speaks)
    std::cout << "Epafi " EPAFI_VERSION ": " << (scene.title.empty() ? options.scene : scene.title) << '\n'
              << std::flush;

  std::optional<Progress> progress;
  if (speaks)
    progress.emplace(std::cout, 5.0);
  SceneRun run = solveScene(scene, list.sublist("Solver"), comm, progress ? &*progress : nullptr);
  run.started = start;
  const std::string files = writeFiles(options, run, *comm);
  if (speaks)
    std::cout << summary(run) << files << std::flush;
  return run.solver->report().status == qp::Status::converged ? solved : notConverged;
}

int run(int argc, char** argv, const RCP<const Comm>& comm) {
  const bool isFirst = comm->getRank() == 0;
  try {
    const Options options = parseOptions(argc, argv);
    if (options.help || options.version || options.printParameters) {
      if (isFirst)
        std::cout << information(options) << std::flush;
      return solved;
    }
    return solve(options, comm);
  } catch (const InputError& error) {
    if (isFirst)
      std::cerr << "epafi: " << error.what() << '\n';
    return wrongInput;
  } catch (const SolvabilityError& error) {
    if (isFirst)
      std::cerr << "epafi: " << error.what() << '\n';
    return notSolvable;
  } catch (const Error& error) { // agreed on by all ranks
    if (isFirst)
      std::cerr << "epafi: " << error.what() << '\n';
    return notConverged;
  }
}

} // namespace

int main(int argc, char** argv) {
  int programNameOnly = 1; // Kokkos would answer --help itself
  Tpetra::ScopeGuard scope(&programNameOnly, &argv);
  const RCP<const Comm> comm = Tpetra::getDefaultComm();
  try {
    return run(argc, argv, comm);
  } catch (const std::exception& error) { // on this rank alone, perhaps: the others must not wait for it
    std::cerr << "epafi: rank " << comm->getRank() << " failed: " << error.what() << std::endl;
    MPI_Abort(MPI_COMM_WORLD, notConverged);
  }
  return notConverged;
}
