#pragma once

/// The plan of a solve: all that parameters leave open, decided in one place by facts of the problem and of
/// the run, each choice with its reason. What is chosen for single subdomains stands in CostModel.hpp, and
/// how bodies are cut, before there is a problem, in model/ClusterSize.hpp.

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/fetidp/operator/FetiParameters.hpp"
#include "epafi/qp/operators/NormEstimate.hpp"
#include "epafi/qp/solve/ActiveSets.hpp"
#include "epafi/qp/solve/MprgpParameters.hpp"
#include "epafi/qp/solve/Smalbe.hpp"

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace epafi::fetidp {

/// From the least to what bounds and floating bodies together need:
///   no multiplier at all   direct solve, nothing to iterate
///   no contact             conjugate gradients on F (Belos)
///   contact, all supported MPRGP
///   floating bodies SMALBE with MPRGP inside, on PFP after the shift by λ̃; or active sets, with Gλ = e held
///   exactly
///   Coulomb's friction     active sets with bounds that follow; or a fixed point of problems with given ones
enum class Algorithm { direct, conjugateGradient, mprgp, smalbe, activeSets, fixedPoint };

/// "Direct", "CG", "MPRGP", "SMALBE-M", "Active sets", "Fixed point".
std::string toString(Algorithm algorithm);

/// How the dual problem is to be solved, and how accurately, as the user gives it.
struct DualParameters : FetiParameters {
  /// Of problems with contact: active sets where bodies float or the start is good, and there is a
  /// preconditioner, and with friction; MPRGP or SMALBE; active sets; where there is friction a fixed point
  /// of its bounds, else active sets. Coulomb's friction is for active sets if MPRGP is asked for.
  enum class Method { automatic, mprgp, activeSets, fixedPoint };
  Method method = Method::automatic; ///< how contact is found
  std::optional<double> tolerance{}; ///< on ‖g^P‖ relative to ‖d̃‖ or ‖Pd‖; none: as the purpose asks
  bool isBalanced = false;           ///< in its place: the algebraic error against the discretisation error
  std::optional<double> algebraicFraction{}; ///< of the discretisation error; none: as the purpose asks
  double equilibriumTolerance = 1e-6; ///< on ‖Gλ − e‖ relative to ‖e‖, or to ‖Pd‖/‖PFP‖ if e vanishes
  qp::MprgpParameters mprgp = {};       ///< of MPRGP, its limits for CG and active sets, too
  qp::SmalbeParameters smalbe = {};     ///< of SMALBE
  qp::NormEstimateParameters norm = {}; ///< of the estimate of ‖F‖
};

/// What a solve is for, which says how far it has to go where the parameters do not.
enum class Purpose {
  solution, ///< the solution itself
  mesh,     ///< one of a series of meshes on the way to a small error
  quantity, ///< one of such a series, where the error is that of a number
  start     ///< a solve on another mesh starts from it
};

/// What those who ask for a solve know beside the problem.
struct RunFacts {
  Purpose purpose = Purpose::solution; ///< what the solve is for
  bool hasStart = false;               ///< λ to start from is there, or comes from a coarser mesh
  bool isUniform = false;   ///< along interfaces the stiffness varies as sizes of elements do, no further
  bool solvesAgain = false; ///< for other data: what saves products may take its time
  /// Unknowns from which on there may be a coarser mesh to begin on.
  GlobalOrdinal coarserFrom = std::numeric_limits<GlobalOrdinal>::max();
};

/// What choices depend on beside the parameters, the same on all ranks. By default nothing is to be solved.
struct PlanFacts {
  GlobalOrdinal numInequalities = 0, numTies = 0, numEqualities = 0; ///< rows of B
  GlobalOrdinal numFriction = 0;                                     ///< rows of friction
  GlobalOrdinal primalDimension = 0;                                 ///< as in DecomposedProblem
  int kernelDimension = 0;                      ///< rigid modes that supports leave to clusters
  std::vector<std::string> floatingBodies = {}; ///< their names
  bool isElastic = false;                       ///< see decomposition::isElastic
  bool hasClusters = false;                     ///< a body is cut into several
  bool hasAverages = false;                     ///< averages along edges are coarse unknowns, somewhere
  bool isCorrected = false;      ///< M is, for jumps of contact: known once it is made, and so is the next
  bool hasDependentRows = false; ///< some rows have no unknown of their own (SharedRows.hpp)
  RunFacts run = {};             ///< what the problem does not tell
};

/// The facts of a problem, as far as they are known before operators are made. Collective.
PlanFacts factsOf(const decomposition::DecomposedProblem& problem, const RunFacts& run = {});

/// All choices.
struct Plan {
  Algorithm algorithm = Algorithm::direct; ///< what solves the problem in the multipliers
  bool beginsOnCoarserMesh = false; ///< the contact zone should be looked for there, if there is such a mesh
  double tolerance = 1e-6;          ///< as DualParameters::tolerance
  bool isBalanced = false;          ///< as DualParameters::isBalanced
  double algebraicFraction = 0.1;   ///< of the discretisation error, where isBalanced
  bool estimatesNorm = false;       ///< whether somebody asks for that of the Hessian
  bool beginsClosed = false;        ///< whether active sets without a start close all contact first
  double faceReduction = qp::ActiveSetParameters().faceReduction; ///< see there
  qp::MprgpParameters mprgp;                                      ///< as given, what was left open decided
  JumpSearch gluing, contact; ///< of jumps that are deflated, and of those that M is corrected for
  /// A sentence on each choice, under the name of the parameter that leaves it open, most often.
  std::map<std::string, std::string> reasons;
};

/// Chooses. Not collective; the same on all ranks.
/// \throws InputError if there is no preconditioner and the error is to be balanced.
Plan plan(const PlanFacts& facts, const DualParameters& parameters);

} // namespace epafi::fetidp
