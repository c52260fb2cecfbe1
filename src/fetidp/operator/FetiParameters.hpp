#pragma once

/// What FETI-DP can be told: direct solvers, the form of F, the preconditioner, adaptive constraints.

#include <Teuchos_ParameterList.hpp>

#include <limits>
#include <string>

namespace epafi::fetidp {

/// Names of the direct solvers (see direct::availableSolvers), and whether identical subdomains share their
/// factor.
struct DirectSolvers {
  std::string subdomains = "CHOLMOD";
  std::string coarse = "CHOLMOD";
  bool shareIdentical = true;
  int maxReplicated = 20000; ///< coarse unknowns; a larger coarse problem is kept and solved on one rank
  bool operator==(const DirectSolvers& other) const = default;
};

/// The form of F.
struct DualOperatorParameters {
  /// How a subdomain's part (K_rr⁻¹)_ΔΔ of F is multiplied with: by a pair of sparse triangular solves, by a
  /// dense block, or by what is less work for so many products.
  enum class Mode { automatic, implicitSolves, explicitBlocks };
  Mode mode = Mode::automatic;
  int expectedProducts = 40; ///< that a setup must pay off in
  bool operator==(const DualOperatorParameters& other) const = default;
};

/// The preconditioner of F.
struct PreconditionerParameters {
  /// A subdomain's part: its stiffness at the interface (lumped), or condensed to it (dirichlet).
  enum class Type { none, lumped, dirichlet };
  /// By what the copies of a node share its forces: equally, or by their stiffness.
  enum class Scaling { multiplicity, stiffness };
  Type type = Type::dirichlet;
  Scaling scaling = Scaling::stiffness;
  bool isSingle = false; ///< blocks in single precision
  bool operator==(const PreconditionerParameters& other) const = default;
};

/// Where jumps are looked for that the preconditioner overrates, and which of them are taken out.
struct AdaptiveConstraintParameters {
  /// Along interfaces with jumps of the stiffness, where there is a preconditioner; along all; nowhere.
  enum class Use { automatic, yes, no };
  Use use = Use::automatic;
  double threshold = 10; ///< τ: jumps that M overrates by more are constrained
  /// Largest over smallest stiffness along an interface, from which on `automatic` looks at it.
  double stiffnessRatio = 10;
  int maxNumber = 1000; ///< constraints at most, n_U
  bool operator==(const AdaptiveConstraintParameters& other) const = default;
};

/// Where jumps are looked for that M overrates (precondition/OverratedColumns.hpp): along no interface, all
/// of them, or, `automatic`, those with jumps of the stiffness.
struct JumpSearch : AdaptiveConstraintParameters {
  bool betweenSubdomains = false; ///< the stiffness may jump from subdomain to subdomain of a body, too
  /// Bytes of dense blocks. Where they would take more, ratioOfLarge takes the place of stiffnessRatio.
  double mostBytes = std::numeric_limits<double>::infinity(), ratioOfLarge = 100;
};

/// All that can be told.
struct FetiParameters {
  DirectSolvers directSolvers = {};
  DualOperatorParameters dualOperator = {};
  PreconditionerParameters preconditioner = {};
  AdaptiveConstraintParameters adaptiveConstraints = {};
  bool operator==(const FetiParameters& other) const = default;
};

/// "none", "lumped", "dirichlet".
std::string toString(PreconditionerParameters::Type type);
/// For people: "dirichlet, stiffness scaling, single precision".
std::string describe(const PreconditionerParameters& parameters);

/// Lists "Direct Solvers", "Dual Operator", "Preconditioner", "Adaptive Constraints".
void addFetiParameters(Teuchos::ParameterList& list);
/// From a validated list with these lists in it.
FetiParameters fetiParametersFrom(const Teuchos::ParameterList& list);
/// From validated lists, each the one of that name.
DirectSolvers directSolversFrom(const Teuchos::ParameterList& list);
DualOperatorParameters dualOperatorFrom(const Teuchos::ParameterList& list);              ///< likewise
PreconditionerParameters preconditionerFrom(const Teuchos::ParameterList& list);          ///< likewise
PreconditionerParameters::Scaling scalingFrom(const Teuchos::ParameterList& list);        ///< likewise
AdaptiveConstraintParameters adaptiveConstraintsFrom(const Teuchos::ParameterList& list); ///< likewise

} // namespace epafi::fetidp
