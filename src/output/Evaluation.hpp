#pragma once

/// What follows from displacements and multipliers, computed once for files and report.

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/output/SolvedScene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <vector>

namespace epafi::output {

struct Evaluation {
  /// Of each body: von Mises stress at this rank's slab of nodes (vonMisesAtNodes); of membranes empty.
  std::vector<std::vector<double>> vonMises;
  /// Of each body: estimated error of this rank's slab of cells (cellErrors); empty if it was not estimated.
  std::vector<std::vector<double>> errors;
  bool hasErrors = false; ///< on all ranks alike
  /// Of each contact: the area on which each row's multiplier acts (pressureAreas).
  std::vector<std::vector<double>> areas;
};

/// \param estimate  null if the error was not estimated
/// Collective.
Evaluation evaluate(const SolvedScene& solved, const accuracy::ErrorEstimate* estimate = nullptr);

/// Adds to a report:
///   Contact/NAME    Candidates (rows), Active Nodes, Force Σλ, Resultant −Σλd (x, y, z; the force on the first body; of
///                   membranes, whose deflection is along z, in z), Largest Pressure max λ/area, Contact Area (that of the
///                   active rows)
///   Body/NAME       of elastic bodies: Largest Displacement (the length of the vector), Largest von Mises Stress
/// Sums are the same to the last digit on any number of ranks. Nothing but the numbers in the lists is ever whole on one rank.
/// Collective.
void addResults(const SolvedScene& solved, const Evaluation& evaluation, Teuchos::ParameterList& report);

} // namespace epafi::output
