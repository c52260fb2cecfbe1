#pragma once

/// What a run has come to, in plain numbers, the same on all ranks: what reports, summaries and scripts are
/// made of.

#include "epafi/ContactSolver.hpp"
#include "epafi/accuracy/AccuracyLoop.hpp"
#include "epafi/accuracy/EnergyBound.hpp"
#include "epafi/simulation/Evaluation.hpp"
#include "epafi/simulation/FreeMotionHolds.hpp"
#include "epafi/simulation/JointResults.hpp"
#include "epafi/simulation/PreloadResults.hpp"
#include "epafi/simulation/Quantity.hpp"
#include "epafi/simulation/SupportResults.hpp"

#include <Teuchos_ParameterList.hpp>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace epafi::simulation {

/// How a run stands.
enum class RunStatus {
  converged,    ///< to all that was asked for
  notConverged, ///< SolveFacts::status says why
  targetMissed, ///< solved, but not as accurately as was asked for
  /// Solved, but strains or rotations are so large that the theory does not hold, where it was to hold.
  largeDisplacements,
  missedContact, ///< solved, but nodes meet that a contact's `Distance` has left out
  interrupted,   ///< by a signal
  running        ///< on to the next mesh or load step
};

/// A coarser mesh on which the contact zone was found first.
struct CoarserStart {
  std::string failure; ///< why the run started without its solution; empty if it did not
  std::string means;   ///< what made it coarser
  GlobalOrdinal unknowns = 0;
  int multiplications = 0; ///< products with F
  double energy = 0;
  double seconds = 0;
};

/// Both errors in the energy norm, as they are estimated.
struct ErrorResult {
  double energyNorm = 0;     ///< ‖u_h‖_K
  double discretisation = 0; ///< of the mesh, divided by the effectivity
  double algebraic = 0;      ///< of the iteration at most; ∞: nothing bounds it; NaN: not known
  double effectivity = 1;    ///< estimate by error, as a series of meshes tells

  /// Both together, relative to the norm of the exact solution.
  [[nodiscard]] double relative() const;
};

/// Seconds, the largest over the ranks; 0 where nothing was done.
struct RunTimes {
  double assembly = 0, recovery = 0, errorEstimate = 0, bound = 0, output = 0, total = 0;
};

/// A run that refined its mesh until an error was small enough.
struct TargetResult {
  double asked = 0;                         ///< relative error
  std::vector<accuracy::MeshResult> meshes; ///< that it went through, without their elements
  std::string choiceOfOrder;                ///< why this order; empty if it was given
};

/// With Coulomb's friction: the factor q by which errors of its bounds shrink, and the products with F that
/// tell.
struct FrictionFeedback {
  double factor = 0;
  int multiplications = 0;
};

/// What a load step has come to.
struct StepResult {
  std::string name;
  int multiplications = 0; ///< products with F
  /// ½uᵀKu, fᵀu (f with the forces of hindered expansion), and what friction took in the step.
  double strainEnergy = 0, loadWork = 0, dissipation = 0;
  std::vector<ContactResult> contacts;
  std::vector<SupportResult> supports;
  std::vector<PreloadResult> preloads;
  std::vector<TieResult> ties;
  std::vector<HoldResult> holds;
  std::string doubts; ///< perhaps empty
  RunStatus status = RunStatus::notConverged;
  std::string reason;                                      ///< one sentence
  std::optional<FrictionFeedback> feedback = std::nullopt; ///< with Coulomb's friction
  /// ErrorResult::relative(); NaN: not estimated.
  double relativeError = std::numeric_limits<double>::quiet_NaN();
};

/// All of it.
struct RunResult {
  std::string title;              ///< of the scene
  std::vector<std::string> notes; ///< what its file was taken for: pairs found, keywords passed over
  SolveFacts solve;
  double relativeProjectedGradient = 0, feasibility = 0, complementarity = 0; ///< as ContactSolution
  double equilibrium = 0, algebraicError = std::numeric_limits<double>::quiet_NaN(), energy = 0;
  GlobalOrdinal activeContactNodes = 0;
  double contactForce = 0;
  double loadWork = 0;                        ///< fᵀu of the loads
  std::optional<FrictionFeedback> feedback;   ///< with Coulomb's friction
  std::optional<ErrorResult> error;           ///< if asked for
  std::optional<accuracy::EnergyBound> bound; ///< if asked for
  std::string doubts; ///< what an estimate does not see, of load steps before the last, too; perhaps empty
  std::string missedContacts;       ///< what overlaps without a row (LeftOutNodes.hpp); empty: nothing
  std::optional<Quantity> quantity; ///< if asked for
  std::optional<CoarserStart> start;
  std::vector<BodyResult> bodies;
  bool choosesClusters = false; ///< whether some body's clusters were left to choose
  std::vector<ContactResult> contacts;
  std::vector<TieResult> ties;
  std::vector<SupportResult> supports;
  std::vector<PreloadResult> preloads;
  std::vector<HoldResult> holds; ///< of motions that would be free
  std::vector<StepResult> steps; ///< in their order, the last one too; none where the scene has none
  std::optional<TargetResult> target;
  RunTimes times;
  RunStatus status = RunStatus::notConverged;
  std::string reason; ///< one sentence
};

/// Sentences where friction is so strong that there may be more than one solution; empty if it is not.
std::string frictionDoubts(const RunResult& result);

/// A sentence where holds take more than noise of the scene's forces; empty if they do not.
std::string loadedHolds(const RunResult& result);

/// A sentence on the bodies that are deformed or turned by more than a limit; empty if there is none.
std::string largeDeformations(const RunResult& result, double limit);

/// Has a run that converged fail with this sentence where displacements are large (Deformation::large).
void requireSmall(RunResult& result);

/// Has a run that has come to an end fail where nodes without a row meet (RunResult::missedContacts).
void requireAllContacts(RunResult& result);

/// "Converged", "TargetMissed", "Interrupted", "Running", or what the iteration ended with.
std::string statusOf(const RunResult& result);

/// The report of a run: the lists Epafi, Problem, Algorithm, Plan, Iterations, Accuracy, Start, Quantity,
/// Body, Contact, Tied, Support, Preload, Holds, Levels, Time, Memory and Status, as far as there is
/// something to say.
Teuchos::ParameterList reportOf(const RunResult& result);

} // namespace epafi::simulation
