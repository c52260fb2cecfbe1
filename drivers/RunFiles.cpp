#include "RunFiles.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/Checkpoint.hpp"
#include "epafi/output/FieldWriter.hpp"
#include "epafi/output/Fingerprint.hpp"
#include "epafi/output/Report.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <iomanip>
#include <iostream>
#include <sstream>
#include <utility>

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

RunFiles::RunFiles(const Options& options, const RunWatch& watch, RCP<const Comm> comm, double started)
    : options_(options), watch_(watch), comm_(std::move(comm)), started_(started), lastMesh_(started) {}

/// Runs `work`, which writes `file` and returns a line that says so; notes what all ranks agree that it could
/// not.
template <class Work>
void RunFiles::attempt(const std::filesystem::path& file, const Work& work) {
  try {
    lines_ += work();
  } catch (const Error& error) {
    failures_.push_back(file.string() + " is not written: " + error.what());
  }
}

void RunFiles::publish(output::FileSet& files) {
  try {
    files.publish();
  } catch (const Error& error) {
    failures_.emplace_back(error.what());
  }
}

/// All but the checkpoint, which is of the mesh that the iteration is on, and says which, get their names
/// later; reports last.
void RunFiles::prepare(SceneRun& run, output::FileSet& files) {
  lines_.clear();
  failures_.clear();
  std::string checkpoint;
  if (!options_.output.empty()) {
    attempt(watch_.checkpoint(), [&] {
      output::writeCheckpoint(watch_.checkpoint(), output::fingerprintOf(run.decomposition->problem),
                              *run.solution.multiplier);
      checkpoint = line("checkpoint", watch_.checkpoint().string());
      return std::string();
    });
    prepareFields(run, files);
  }
  if (std::string& reason = run.report.sublist("Status").get<std::string>("Reason");
      hasMesh_ && !failures_.empty())
    reason += "; not all files of this mesh could be written: what is missing may be there of a mesh before";
  enterTimes(run);
  for (const std::filesystem::path& file : reportsOf(options_))
    attempt(file, [&] {
      output::writeReport(run.report, file, files);
      return line("report", file.string());
    });
  lines_ += checkpoint;
}

void RunFiles::prepareFields(SceneRun& run, output::FileSet& files) {
  const std::filesystem::path directory = options_.output, history = directory / "history.csv";
  std::string table;
  attempt(history, [&] {
    output::writeHistory(run.solver->report().history, history, files);
    table = line("history", history.string());
    return std::string();
  });
  const std::string name = std::filesystem::path(options_.scene).stem().string();
  attempt(directory / (name + ".h5"), [&] {
    const auto fields = output::writeFields(directory, name, run.solved(), run.evaluation,
                                            run.solver->report().history, files);
    return line("fields", fields.hdf5.string() + " and " + fields.xdmf.string());
  });
  lines_ += table;
  if (run.report.isSublist("Levels"))
    attempt(directory / "meshes.csv", [&] {
      const Teuchos::ParameterList& levels = run.report.sublist("Levels");
      files.write(directory / "meshes.csv", [&] { return tableOfMeshes(levels); });
      return line("meshes", (directory / "meshes.csv").string());
    });
}

void RunFiles::enterTimes(SceneRun& run) {
  const double now = Teuchos::Time::wallTime();
  run.report.sublist("Time")
      .set("Output", maxOverRanks(*comm_, output_ + now - began_))
      .set("Total", maxOverRanks(*comm_, now - started_));
}

/// Whoever finds this report when the run was killed is warned.
void RunFiles::announce(const SceneRun& run) {
  Teuchos::ParameterList report(run.report);
  report.sublist("Status").set(
      "Reason",
      std::string("the files of this mesh are being put in place: each is complete, and of this mesh or "
                  "older; where none puts them there any more the run was killed just then"));
  output::FileSet files(comm_, false); // for less than a millisecond
  for (const std::filesystem::path& file : reportsOf(options_))
    attempt(file, [&] {
      output::writeReport(report, file, files);
      return std::string();
    });
  publish(files);
}

void RunFiles::writeMesh(SceneRun& run) {
  constexpr double often = 1; // seconds; what fewer of them brought is not worth a wait for the disk
  began_ = Teuchos::Time::wallTime();
  output::FileSet files(comm_, maxOverRanks(*comm_, began_ - lastMesh_) > often);
  prepare(run, files);
  if (failures_.empty()) {
    announce(run);
    publish(files);
  }
  isOfThisMesh_ = failures_.empty();
  hasMesh_ = hasMesh_ || isOfThisMesh_;
  if (!isOfThisMesh_ && comm_->getRank() == 0 && !std::exchange(hasComplained_, true))
    std::cerr << "epafi: the run goes on without files of this mesh: " << failures_.front() << '\n'
              << std::flush;
  lastMesh_ = Teuchos::Time::wallTime();
  output_ += lastMesh_ - began_;
}

void RunFiles::finish(SceneRun& run) {
  began_ = Teuchos::Time::wallTime();
  if (!isOfThisMesh_) {
    output::FileSet files(comm_);
    prepare(run, files);
    publish(files);
    return;
  }
  enterTimes(run);
  for (const std::filesystem::path& file : reportsOf(options_))
    attempt(file, [&] {
      output::writeReport(run.report, file, *comm_);
      return std::string();
    });
}

} // namespace epafi::drivers
