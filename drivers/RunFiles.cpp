#include "RunFiles.hpp"

#include "DeckFiles.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/Checkpoint.hpp"
#include "epafi/output/FieldSteps.hpp"
#include "epafi/output/Fingerprint.hpp"
#include "epafi/output/Report.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <algorithm>
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

std::string tableOf(const std::vector<accuracy::MeshResult>& meshes) {
  std::ostringstream table;
  table << "mesh,order,unknowns,hessian_multiplications,relative_error,discretisation_error,algebraic_error,"
           "effectivity,seconds";
  const bool haveQuantity = meshes.front().quantity.has_value();
  table << (haveQuantity ? ",quantity,error_bar\n" : "\n");
  table.precision(6);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const accuracy::MeshResult& mesh = meshes[i];
    table << i << ',' << mesh.order << ',' << mesh.unknowns << ',' << mesh.multiplications;
    for (const double number :
         {mesh.relative(), mesh.discretisation, mesh.algebraic, mesh.effectivity, mesh.seconds})
      table << ',' << number;
    if (haveQuantity && mesh.quantity)
      table << ',' << std::setprecision(9) << mesh.quantity->value << std::setprecision(6) << ','
            << mesh.quantity->discretisation + mesh.quantity->algebraic;
    else if (haveQuantity)
      table << ",,";
    table << '\n';
  }
  return table.str();
}

/// A line each step and contact.
std::string tableOf(const std::vector<simulation::StepResult>& steps) {
  std::ostringstream table;
  table << "number,step,hessian_multiplications,strain_energy,load_work,dissipation,contact,force,"
           "resultant_x,resultant_y,resultant_z,largest_pressure,contact_area,tangential_x,tangential_y,"
           "tangential_z,stick_area,slip_area,open_area,largest_slip,contact_dissipation\n";
  table.precision(12);
  const auto quoted = [](std::string name) {
    for (std::size_t at = name.find('"'); at != std::string::npos; at = name.find('"', at + 2))
      name.insert(at, 1, '"');
    return '"' + name + '"';
  };
  for (std::size_t k = 0; k < steps.size(); ++k)
    for (const simulation::ContactResult& contact : steps[k].contacts) {
      table << k + 1 << ',' << quoted(steps[k].name) << ',' << steps[k].multiplications;
      for (const double number : {steps[k].strainEnergy, steps[k].loadWork, steps[k].dissipation})
        table << ',' << number;
      table << ',' << quoted(contact.name);
      const auto& [x, y, z] = contact.resultant;
      for (const double number : {contact.force, x, y, z, contact.largestPressure, contact.area})
        table << ',' << number;
      if (const auto& friction = contact.friction)
        for (const double number : {friction->tangentialForce[0], friction->tangentialForce[1],
                                    friction->tangentialForce[2], friction->stickArea, friction->slipArea,
                                    friction->openArea, friction->largestSlip, friction->dissipation})
          table << ',' << number;
      else
        table << ",,,,,,,,";
      table << '\n';
    }
  return table.str();
}

/// What a stage is.
std::string stageOf(const simulation::RunResult& result) {
  return result.steps.empty() ? "mesh" : "step";
}

} // namespace

RunFiles::RunFiles(const Options& options, const RunWatch& watch, RCP<const Comm> comm, double started,
                   const std::string& notes)
    : options_(options), watch_(watch), comm_(std::move(comm)), started_(started), lastStage_(started) {
  constexpr std::size_t wordInFront = 14; // "  deck        "
  for (const std::string& line : linesOf(notes))
    notes_.push_back(line.substr(std::min(line.size(), wordInFront)));
}

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

/// Returns whether all files are in place; notes what all ranks agree that is not.
bool RunFiles::publish(output::FileSet& files) {
  try {
    files.publish();
    return true;
  } catch (const Error& error) {
    failures_.emplace_back(error.what());
    return false;
  }
}

void RunFiles::goOn() {
  const simulation::StepsDone* const done = watch_.stepsDone();
  if (done == nullptr)
    return;
  numEarlier_ = done->results.size();
  earlierSlip_ = done->slip;
  if (options_.output.empty())
    return;
  older_ = std::filesystem::path(options_.restart).parent_path() /
           (std::filesystem::path(options_.scene).stem().string() + ".h5");
  steps_ = output::stepsIn(older_, done->results, *comm_);
  auto there = steps_.begin();
  for (const simulation::StepResult& step : done->results)
    if (there != steps_.end() && there->name == step.name)
      ++there;
    else
      lost_.push_back("fields of step \"" + step.name + "\" are not in the files: " + older_.string() +
                      ", where the run that solved it had them, is not there or has others");
}

/// All but the checkpoint, which is of the stage that the iteration is on, and says which, get their names
/// later; reports last.
void RunFiles::prepare(simulation::SceneRun& run, output::FileSet& files) {
  lines_.clear();
  failures_.clear();
  std::string checkpoint;
  if (!options_.output.empty()) {
    attempt(watch_.checkpoint(), [&] {
      output::writeCheckpoint(watch_.checkpoint(), output::fingerprintOf(run.decomposition->problem),
                              *run.solution.multiplier, watch_.stepsDone());
      checkpoint = line("checkpoint", watch_.checkpoint().string());
      return std::string();
    });
    prepareFields(run, files);
  }
  if (!options_.frd.empty())
    prepareFrd(run, files);
  if (!options_.dat.empty())
    preparePrints(run, files);
  if (hasStage_ && !failures_.empty())
    run.result.reason += "; not all files of this " + stageOf(run.result) +
                         " could be written: what is missing may be there of a " + stageOf(run.result) +
                         " before";
  enterTimesAndNotes(run);
  for (const std::filesystem::path& file : reportsOf(options_))
    attempt(file, [&] {
      output::writeReport(simulation::reportOf(run.result), file, files);
      return line("report", file.string());
    });
  lines_ += checkpoint;
}

void RunFiles::prepareFields(simulation::SceneRun& run, output::FileSet& files) {
  const std::filesystem::path directory = options_.output, history = directory / "history.csv";
  std::string table;
  attempt(history, [&] {
    output::writeHistory(run.solver->report().history, history, files);
    table = line("history", history.string());
    return std::string();
  });
  const std::string name = std::filesystem::path(options_.scene).stem().string();
  const std::vector<simulation::StepResult>& steps = run.result.steps;
  if (!steps.empty())
    steps_.push_back({steps.back().name, static_cast<int>(steps.size())});
  hasFields_ = false;
  attempt(directory / (name + ".h5"), [&] {
    const auto fields = output::writeFields(directory, name, run.solved(), run.evaluation,
                                            run.solver->report().history, files, steps_, older_);
    hasFields_ = true;
    return line("fields", fields.hdf5.string() + " and " + fields.xdmf.string());
  });
  lines_ += table;
  if (!steps.empty())
    attempt(directory / "steps.csv", [&] {
      files.write(directory / "steps.csv", [&] { return tableOf(steps); });
      return line("steps", (directory / "steps.csv").string());
    });
  if (run.result.target)
    attempt(directory / "meshes.csv", [&] {
      files.write(directory / "meshes.csv", [&] { return tableOf(run.result.target->meshes); });
      return line("meshes", (directory / "meshes.csv").string());
    });
}

void RunFiles::prepareFrd(simulation::SceneRun& run, output::FileSet& files) {
  attempt(options_.frd, [&] {
    const std::vector<simulation::StepResult>& steps = run.result.steps;
    if (steps.size() < numEarlier_ + 2) // of other meshes before
      collectively(*comm_, [&] {
        const bool isOwnMesh = !run.result.target; // finer ones have numbers of their own
        frd_ = output::FrdFile(comm_->getRank() == 0 && isOwnMesh ? numberingOf(options_.scene)
                                                                  : output::FrdNumbering(),
                               earlierSlip_);
      });
    if (steps.empty())
      frd_.add(run.solved(), run.evaluation);
    else
      frd_.add(run.solved(), run.evaluation, {steps.back().name, static_cast<int>(steps.size())});
    files.write(options_.frd, [&] { return frd_.text(); });
    return line("frd", options_.frd);
  });
}

void RunFiles::preparePrints(simulation::SceneRun& run, output::FileSet& files) {
  attempt(options_.dat, [&] {
    const std::size_t numSteps = std::max<std::size_t>(1, run.result.steps.size());
    if (numSteps < numEarlier_ + 2)
      collectively(*comm_,
                   [&] { prints_ = DeckPrints(comm_->getRank() == 0 ? options_.scene : "", earlierSlip_); });
    prints_.add(run, numSteps - 1);
    files.write(options_.dat, [&] { return prints_.text(); });
    return line("dat", options_.dat);
  });
}

void RunFiles::enterTimesAndNotes(simulation::SceneRun& run) {
  const double now = Teuchos::Time::wallTime();
  run.result.times.output = maxOverRanks(*comm_, output_ + now - began_);
  run.result.times.total = maxOverRanks(*comm_, now - started_);
  run.result.notes = notes_;
}

/// Whoever finds this report when the run was killed is warned.
void RunFiles::announce(const simulation::SceneRun& run) {
  simulation::RunResult result(run.result);
  const std::string stage = stageOf(result);
  result.reason = "the files of this " + stage + " are being put in place: each is complete, and of this " +
                  stage + " or older; where none puts them there any more the run was killed just then";
  const Teuchos::ParameterList report = simulation::reportOf(result);
  output::FileSet files(comm_, false); // for less than a millisecond
  for (const std::filesystem::path& file : reportsOf(options_))
    attempt(file, [&] {
      output::writeReport(report, file, files);
      return std::string();
    });
  publish(files);
}

/// No later step writes them, and the next one's are to come beside those that are there.
void RunFiles::noteLostFields() {
  if (steps_.empty() || hasFields_)
    return;
  lost_.push_back("fields of step \"" + steps_.back().name + "\" are not in the files: " + failures_.front());
  steps_.pop_back();
}

void RunFiles::writeStage(simulation::SceneRun& run) {
  constexpr double often = 1; // seconds; what fewer of them brought is not worth a wait for the disk
  began_ = Teuchos::Time::wallTime();
  output::FileSet files(comm_, maxOverRanks(*comm_, began_ - lastStage_) > often);
  prepare(run, files);
  if (failures_.empty() || !run.result.steps.empty()) {
    announce(run);
    hasFields_ = publish(files) && hasFields_;
    if (hasFields_)
      older_.clear();
  }
  isOfThisStage_ = failures_.empty();
  hasStage_ = hasStage_ || isOfThisStage_;
  if (!isOfThisStage_ && comm_->getRank() == 0 && !std::exchange(hasComplained_, true))
    std::cerr << "epafi: the run goes on without files of this " << stageOf(run.result) << ": "
              << failures_.front() << '\n'
              << std::flush;
  noteLostFields();
  lastStage_ = Teuchos::Time::wallTime();
  output_ += lastStage_ - began_;
}

void RunFiles::finish(simulation::SceneRun& run) {
  began_ = Teuchos::Time::wallTime();
  if (!isOfThisStage_ || !run.result.steps.empty()) { // the last step has been no stage
    for (const std::string& fields : lost_)
      run.result.reason += "; " + fields;
    output::FileSet files(comm_);
    prepare(run, files);
    publish(files);
    failures_.insert(failures_.begin(), lost_.begin(), lost_.end());
    return;
  }
  enterTimesAndNotes(run);
  for (const std::filesystem::path& file : reportsOf(options_))
    attempt(file, [&] {
      output::writeReport(simulation::reportOf(run.result), file, *comm_);
      return std::string();
    });
}

} // namespace epafi::drivers
