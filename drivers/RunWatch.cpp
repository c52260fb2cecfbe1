#include "RunWatch.hpp"

#include "StopSignals.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/simulation/StepRun.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <iomanip>
#include <iostream>
#include <iterator>
#include <utility>

namespace epafi::drivers {

RunWatch::RunWatch(const Options& options, RCP<const Comm> comm)
    : comm_(std::move(comm)), speaks_(comm_->getRank() == 0), interval_(options.checkpointInterval),
      lastCheckpoint_(Teuchos::Time::wallTime()), lastLine_(lastCheckpoint_),
      tellsProgress_(speaks_ && !options.quiet) {
  if (!options.output.empty())
    checkpoint_ = std::filesystem::path(options.output) / "checkpoint.epafi";
  if (!options.restart.empty())
    restart_ = output::readCheckpoint(options.restart, *comm_);
}

std::string RunWatch::signal() const {
  return agreedText(*comm_, stopSignal());
}

void RunWatch::requireNoSignal(const std::string& when) const {
  if (const std::string name = signal(); !name.empty())
    throw simulation::Interrupted("stopped by " + name + ' ' + when +
                                  ", before the iteration: there is nothing to keep; start again");
}

RCP<const Vector> RunWatch::begin(const decomposition::DecomposedProblem& problem) {
  requireNoSignal("after the assembly");
  if (!checkpoint_.empty() || restart_)
    fingerprint_ = output::fingerprintOf(problem);
  if (!restart_)
    return Teuchos::null;
  try {
    const RCP<const Vector> lambda = output::multipliersOf(*restart_, problem, fingerprint_);
    restart_.reset();
    return lambda;
  } catch (const InputError&) { // on all ranks
    const bool mayBeOther = isSeries_ || (done_ && done_->changesRows);
    if (!mayBeOther)
      throw;
    return Teuchos::null; // of another mesh or step
  }
}

void RunWatch::expectSteps(const Task& task) {
  const std::vector<scene::Step>& steps = task.steps;
  marks_ = task.marks;
  if (!restart_ || !restart_->steps)
    return;
  done_ = std::move(restart_->steps);
  const auto refuse = [&](const std::string& what) {
    throw InputError("the checkpoint '" + restart_->file.string() + "' " + what +
                     "; name the checkpoint of a run of this scene, or start without one");
  };
  const std::size_t number = done_->results.size();
  if (steps.empty())
    refuse("was written between load steps, and this scene has none");
  if (done_->marks.size() != number + 1 || done_->marks.front() != marks_.front())
    refuse("belongs to another scene, or to this one before it was changed");
  for (std::size_t k = 0; k < number; ++k) {
    const std::string& name = done_->results[k].name;
    if (k >= steps.size() || steps[k].name != name)
      refuse("has done step \"" + name + "\" as number " + std::to_string(k + 1) + ", where this scene has " +
             (k < steps.size() ? "\"" + steps[k].name + '"' : "no more"));
    if (done_->marks[k + 1] != marks_[k + 1])
      refuse("has done step \"" + name + "\" with other words than this scene has for it");
  }
  if (number == steps.size())
    throw InputError("the checkpoint '" + restart_->file.string() + "' has done all " +
                     std::to_string(number) + " load steps of this scene; add some, or start without it");
  done_->changesRows = simulation::changesRows(task.scene, steps, number);
}

void RunWatch::stepDone(const simulation::StepsDone& done) {
  done_ = done;
  done_->marks.assign(marks_.begin(), marks_.begin() + 1 + std::ssize(done.results));
}

void RunWatch::beforeIteration() {
  requireNoSignal("after the setup");
  lastCheckpoint_ = Teuchos::Time::wallTime();
}

bool RunWatch::lineIsDue() {
  constexpr double interval = 5; // seconds between lines that tell people that a long run is alive
  const double now = Teuchos::Time::wallTime();
  if (!tellsProgress_ || now - lastLine_ < interval)
    return false;
  lastLine_ = now;
  return true;
}

void RunWatch::meshing() {
  if (lineIsDue())
    std::cout << "  meshing ...\n" << std::flush;
}

void RunWatch::step(const qp::StepRecord& record) {
  if (!lineIsDue())
    return;
  std::cout << "  step " << record.iteration << " (" << static_cast<char>(record.kind)
            << "): projected gradient " << std::scientific << std::setprecision(2) << record.projectedGradient
            << ", " << record.activeBounds << " at bounds, " << record.hessianMultiplications << " products\n"
            << std::flush;
}

bool RunWatch::wantsToStop() {
  return !stopSignal().empty();
}

/// A checkpoint is due; or it is the last chance: a batch system may leave less time than the recovery takes.
bool RunWatch::wantsToLook() {
  if (checkpoint_.empty())
    return false;
  const bool isDue = speaks_ && interval_ > 0 && Teuchos::Time::wallTime() - lastCheckpoint_ >= interval_;
  return isDue || wantsToStop();
}

void RunWatch::look(const Vector& lambda) {
  try {
    output::writeCheckpoint(checkpoint_, fingerprint_, lambda, stepsDone());
  } catch (const Error& error) {
    if (speaks_ && !std::exchange(hasComplained_, true))
      std::cerr << "epafi: the run goes on without a checkpoint: " << error.what() << '\n' << std::flush;
  }
  lastCheckpoint_ = Teuchos::Time::wallTime();
}

} // namespace epafi::drivers
