#include "RunFiles.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/Checkpoint.hpp"
#include "epafi/output/FieldWriter.hpp"
#include "epafi/output/Fingerprint.hpp"
#include "epafi/output/Report.hpp"

#include <Teuchos_Time.hpp>

#include <iomanip>
#include <sstream>

namespace epafi::drivers {

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

namespace {

/// Runs `work`, which writes `file` and says so in the lines that it returns; notes what all ranks agree that it could not.
template <class Work>
void attempt(WrittenFiles& files, const std::filesystem::path& file, const Work& work) {
  try {
    files.lines += work();
  } catch (const Error& error) {
    files.failures.push_back(file.string() + " is not written: " + error.what());
  }
}

std::string line(std::string label, const std::string& text) {
  label.resize(12, ' ');
  return "  " + label + text + '\n';
}

/// The list Levels of a report as a table.
std::string tableOfMeshes(const Teuchos::ParameterList& levels) {
  std::ostringstream table;
  table << "mesh,order,unknowns,hessian_multiplications,relative_error,discretisation_error,algebraic_error,"
           "effectivity,seconds";
  const bool haveQuantity =
      Teuchos::getValue<Teuchos::ParameterList>(levels.entry(levels.begin())).isParameter("Quantity");
  table << (haveQuantity ? ",quantity,error_bar\n" : "\n");
  table.precision(6);
  int number = 0;
  for (auto entry = levels.begin(); entry != levels.end(); ++entry, ++number) {
    const auto& mesh = Teuchos::getValue<Teuchos::ParameterList>(levels.entry(entry));
    table << number << ',' << mesh.get<int>("Order") << ',' << mesh.get<GlobalOrdinal>("Primal Dimension")
          << ',' << mesh.get<int>("Hessian Multiplications");
    for (const char* name :
         {"Relative Error", "Discretisation Error", "Algebraic Error", "Effectivity", "Seconds"})
      table << ',' << mesh.get<double>(name);
    if (haveQuantity && mesh.isParameter("Quantity"))
      table << ',' << std::setprecision(9) << mesh.get<double>("Quantity") << std::setprecision(6) << ','
            << mesh.get<double>("Error Bar");
    else if (haveQuantity)
      table << ",,";
    table << '\n';
  }
  return table.str();
}

} // namespace

WrittenFiles writeFiles(const Options& options, const RunWatch& watch, SceneRun& run, const Comm& comm) {
  WrittenFiles files;
  const double start = Teuchos::Time::wallTime();
  const qp::History& history = run.solver->report().history;
  std::string checkpoint;
  if (!options.output.empty()) {
    const std::filesystem::path directory = options.output;
    attempt(files, watch.checkpoint(), [&] {
      output::writeCheckpoint(watch.checkpoint(), output::fingerprintOf(run.decomposition->problem),
                              *run.solution.multiplier);
      checkpoint = line("checkpoint", watch.checkpoint().string());
      return std::string();
    });
    std::string table;
    attempt(files, directory / "history.csv", [&] {
      output::writeHistory(history, directory / "history.csv", comm);
      table = line("history", (directory / "history.csv").string());
      return std::string();
    });
    const std::string name = std::filesystem::path(options.scene).stem().string();
    attempt(files, directory / (name + ".h5"), [&] {
      const auto fields = output::writeFields(directory, name, run.solved(), run.evaluation, history);
      return line("fields", fields.hdf5.string() + " and " + fields.xdmf.string());
    });
    files.lines += table;
    if (run.report.isSublist("Levels"))
      attempt(files, directory / "meshes.csv", [&] {
        const Teuchos::ParameterList& levels = run.report.sublist("Levels");
        output::writeTextFile(
            directory / "meshes.csv", [&] { return tableOfMeshes(levels); }, comm);
        return line("meshes", (directory / "meshes.csv").string());
      });
  }
  const double now = Teuchos::Time::wallTime();
  run.report.sublist("Time").set("Output", maxOverRanks(comm, now - start));
  run.report.sublist("Time").set("Total", maxOverRanks(comm, now - run.started));
  for (const std::filesystem::path& file : reportsOf(options))
    attempt(files, file, [&] {
      output::writeReport(run.report, file, comm);
      return line("report", file.string());
    });
  files.lines += checkpoint;
  return files;
}

} // namespace epafi::drivers
