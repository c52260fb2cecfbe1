#pragma once

/// A scene on its meshes, as the loop that leads to a target sees it: solved, and refined everywhere or where
/// the error is.

#include "epafi/simulation/AccuracyParameters.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/accuracy/AccuracyLoop.hpp"

#include <memory>
#include <vector>

namespace epafi::simulation {

/// Each run starts from the last one's solution.
class SceneLevels : public accuracy::RefinableProblem {
public:
  /// \param solverParameters  the list Solver
  SceneLevels(const Teuchos::ParameterList& solverParameters, QuantityParameters quantity,
              RCP<const Comm> comm, RunCompanion* companion);

  accuracy::MeshResult solve(int order) final;
  void boundEnergies() { isBounded_ = true; }    ///< of each mesh, with a guarantee
  [[nodiscard]] SceneRun& run() { return run_; } ///< the last one
  [[nodiscard]] const SceneRun& run() const { return run_; }

protected:
  /// The scene with an order, and its bodies unless it has them itself.
  virtual scene::Scene prepare(int order, std::vector<model::BodyLayout>& bodies) = 0;
  virtual accuracy::ElementErrors elementsOf(const SceneRun& run) = 0;
  /// Whether estimates are to be measured.
  [[nodiscard]] virtual bool measuresChange() const = 0;
  [[nodiscard]] const Comm& comm() const { return *comm_; }
  [[nodiscard]] RunCompanion* companion() const { return companion_; }

private:
  accuracy::MeshResult resultOf(const SceneRun& run);

  Teuchos::ParameterList solverParameters_;
  QuantityParameters quantity_;
  RCP<const Comm> comm_;
  RunCompanion* companion_;
  SceneRun run_;
  bool hasRun_ = false, isBounded_ = false;
  double start_, bytesBefore_;
};

/// As the parameters say. Collective. \throws InputError if a file cannot be read or meshed.
std::unique_ptr<SceneLevels> levelsOf(const scene::Scene& scene,
                                      const Teuchos::ParameterList& solverParameters,
                                      const AccuracyParameters& accuracy, const RCP<const Comm>& comm,
                                      RunCompanion* companion);

} // namespace epafi::simulation
