#pragma once

/// The files of a run of the driver.

#include "DeckPrints.hpp"
#include "Options.hpp"
#include "RunWatch.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/output/FieldWriter.hpp"
#include "epafi/output/FileSet.hpp"
#include "epafi/output/FrdFile.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace epafi::drivers {

/// DIR/report.xml and the file of --report, as far as they were asked for; not twice the same.
std::vector<std::filesystem::path> reportsOf(const Options& options);

/// Writes what was asked for: checkpoint, history, fields, results as CalculiX has them, reports, the
/// smallest first. A file that cannot be written does not keep the others from it. All methods are
/// collective; what they note is the same on all ranks.
class RunFiles {
public:
  /// \param started  wall time at the start of the run  \param notes  lines for the reports
  RunFiles(const Options& options, const RunWatch& watch, RCP<const Comm> comm, double started,
           const std::string& notes);

  /// Load steps that the watch knows as done are not told of again: their fields are those in the file
  /// beside the checkpoint; which are not there, finish() says.
  void goOn();
  /// The files of a stage, that is a mesh of several or a load step, in place of those of the stage before:
  /// all, with a report that says that the run goes on, or, of a mesh, none, and the run goes on without, of
  /// which rank 0 tells once. They are put in place together, between a report that says so and the one that
  /// is to stay. Fields of a step come beside those of the steps before.
  void writeStage(simulation::SceneRun& run);
  /// Those of a run that is over; of its last mesh, if that has them, the reports alone. Enters Time/Output,
  /// that of all stages, and Time/Total in the run's report, as writeStage() does.
  void finish(simulation::SceneRun& run);

  [[nodiscard]] const std::string& lines() const { return lines_; } ///< for people: what was written where
  /// Sentences about what could not be written, by finish().
  [[nodiscard]] const std::vector<std::string>& failures() const { return failures_; }

private:
  template <class Work>
  void attempt(const std::filesystem::path& file, const Work& work);
  bool publish(output::FileSet& files);
  void prepare(simulation::SceneRun& run, output::FileSet& files);
  void prepareFields(simulation::SceneRun& run, output::FileSet& files);
  void prepareFrd(simulation::SceneRun& run, output::FileSet& files);
  void preparePrints(simulation::SceneRun& run, output::FileSet& files);
  void enterTimesAndNotes(simulation::SceneRun& run);
  void announce(const simulation::SceneRun& run);
  void noteLostFields();

  const Options& options_;
  const RunWatch& watch_;
  RCP<const Comm> comm_;
  std::vector<std::string> notes_;
  double started_, began_ = 0; ///< wall time: of the run, of the work at hand
  double output_ = 0;          ///< seconds that all before it took
  double lastStage_;           ///< wall time at which its files were there
  bool hasStage_ = false, isOfThisStage_ = false, hasComplained_ = false;
  bool hasFields_ = false;                        ///< those of the stage at hand are written
  std::vector<output::FieldStep> steps_;          ///< up to the one at hand, but those whose fields are lost
  std::filesystem::path older_;                   ///< HDF5 file of the steps of an earlier run; empty: none
  std::size_t numEarlier_ = 0;                    ///< load steps that an earlier run has done
  std::vector<simulation::NodeSlip> earlierSlip_; ///< what friction has slipped in them
  output::FrdFile frd_;                           ///< of the mesh at hand, up to the step at hand
  DeckPrints prints_{""};                         ///< likewise
  std::string lines_;
  std::vector<std::string> failures_;
  std::vector<std::string> lost_; ///< likewise, of fields of steps that no later stage makes up for
};

} // namespace epafi::drivers
