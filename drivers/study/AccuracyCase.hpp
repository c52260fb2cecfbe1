#pragma once

/// One way to solve a problem of the accuracy study, measured.

#include "AccuracyReference.hpp"
#include "AccuracyTable.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

/// Settings that differ from the program's defaults.
struct AccuracyVariant {
  std::string name;
  std::string tolerance;      ///< a number, or "balanced"; empty: the default
  std::string preconditioner; ///< none, lumped, dirichlet; empty: the default
  std::string precision;      ///< of the preconditioner; empty: the default
  std::string dualOperator;   ///< implicit, explicit; empty: the default
  bool isNested = false;      ///< from the coarsest mesh on, each from the last one's solution

  /// The list Solver.
  [[nodiscard]] Teuchos::ParameterList parameters() const;
  /// The tolerance in words, that of the default too.
  [[nodiscard]] std::string toleranceInWords() const;
};

/// Those of the work–precision diagrams, on every mesh; "default" is the first.
std::vector<AccuracyVariant> variantsOnMeshes();

/// Each preconditioner with tolerances from 1e-1 to 1e-10, for one mesh: what a digit of the iteration costs.
std::vector<AccuracyVariant> variantsOfTolerance(bool quick);

/// The name of a preconditioner's ladder of tolerances starts with this.
constexpr const char* ladderName = "ladder_";

/// Solves a problem on a mesh of its ladder by all variants in turns, several times over, so that a busy machine does them
/// all the same harm. Times are medians. Rows of iterations
/// that stop early say so. Collective.
/// \param budget  seconds after which there is no further round
std::vector<AccuracyRow> measureVariants(const AccuracyProblem& problem, int level,
                                         const AccuracyReference& reference,
                                         const std::vector<AccuracyVariant>& variants, double budget,
                                         const RCP<const Comm>& comm);

} // namespace epafi::drivers
