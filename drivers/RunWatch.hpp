#pragma once

/// What the driver does while a run goes on: lines for people, signals, checkpoints, and the start from one.

#include "Options.hpp"
#include "Task.hpp"
#include "epafi/simulation/SceneRun.hpp"
#include "epafi/simulation/StepsDone.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/output/Checkpoint.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace epafi::drivers {

class RunWatch final : public simulation::RunCompanion {
public:
  /// Reads the checkpoint of --restart. Precondition: listenToStopSignals() was called. Collective. \throws
  /// InputError if it cannot be read.
  RunWatch(const Options& options, RCP<const Comm> comm);

  /// λ of that checkpoint. \throws InputError if it does not fit the problem, simulation::Interrupted if a
  /// signal has come.
  RCP<const Vector> begin(const decomposition::DecomposedProblem& problem) override;
  /// \throws simulation::Interrupted if a signal has come.
  void beforeIteration() override;

  void meshing() override;
  void step(const qp::StepRecord& record) override;
  [[nodiscard]] bool wantsToStop() override;
  [[nodiscard]] bool wantsToLook() override;
  /// Writes a checkpoint; should that fail, rank 0 says so once, and the run goes on.
  void look(const Vector& lambda) override;
  [[nodiscard]] const simulation::StepsDone* stepsDone() const override { return done_ ? &*done_ : nullptr; }
  void stepDone(const simulation::StepsDone& done) override;

  /// From now on there are several meshes, and the checkpoint is of one of them: it waits until that comes.
  void expectSeries() { isSeries_ = true; }
  /// The scene's load steps; those of the checkpoint are done. Not collective. \throws InputError, on all
  /// ranks alike, if these are others, or of another scene
  void expectSteps(const Task& task);
  /// Whether the run is to start from a checkpoint, and has not yet.
  [[nodiscard]] bool restarts() const { return restart_.has_value(); }
  /// DIR/checkpoint.epafi; empty without --output.
  [[nodiscard]] const std::filesystem::path& checkpoint() const { return checkpoint_; }
  /// "SIGTERM" on all ranks if one received it; empty if none did. Collective.
  [[nodiscard]] std::string signal() const;

private:
  void requireNoSignal(const std::string& when) const;
  /// Whether no line has been written for some seconds; notes that one is now.
  [[nodiscard]] bool lineIsDue();

  RCP<const Comm> comm_;
  bool speaks_;
  std::filesystem::path checkpoint_;
  std::optional<output::Checkpoint> restart_;
  std::optional<simulation::StepsDone> done_;
  std::vector<std::uint64_t> marks_; ///< of the scene's steps
  double interval_, lastCheckpoint_, lastLine_;
  bool tellsProgress_;
  bool hasComplained_ = false, isSeries_ = false;
  output::Fingerprint fingerprint_;
};

} // namespace epafi::drivers
