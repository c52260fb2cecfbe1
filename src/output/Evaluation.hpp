#pragma once

/// What follows from displacements and multipliers, computed once for files and report.

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/output/ContactState.hpp"
#include "epafi/output/SolvedScene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <vector>

namespace epafi::output {

/// Von Mises stress at the nodes of body `body`, of this rank's slab (evenShare of the nodes). Linear
/// elements have their stress at their centres; a node has the mean of the elements around it, weighted by
/// their areas or volumes, of every component of the tensor, and von Mises' norm of that: exact where the
/// stress is constant, O(h²) inside uniform meshes, and the same for every cut and number of ranks but for
/// round-off. Between two materials it is the mean of both sides. Each rank looks at the elements of its own
/// subdomains. Precondition: the body is elastic. Collective.
std::vector<double> vonMisesAtNodes(const SolvedScene& solved, int body);

/// η_T, the error in the energy norm of each cell of a body, of this rank's slab (evenShare of the cells).
/// The root of the sum of their squares over all bodies is the estimate. Collective.
std::vector<double> cellErrors(const SolvedScene& solved, const accuracy::ErrorEstimate& estimate, int body);

struct Evaluation {
  /// Of each body: von Mises stress at this rank's slab of nodes (vonMisesAtNodes); of membranes empty.
  std::vector<std::vector<double>> vonMises;
  /// Of each body: estimated error of this rank's slab of cells (cellErrors); empty if it was not estimated.
  std::vector<std::vector<double>> errors;
  bool hasErrors = false; ///< on all ranks alike
  std::vector<ContactState> contacts;
};

/// \param estimate  null if the error was not estimated
/// Collective.
Evaluation evaluate(const SolvedScene& solved, const accuracy::ErrorEstimate* estimate = nullptr);

/// Adds to a report:
///   Contact/NAME Candidates (rows), Active Nodes, Force Σλ, Resultant −Σλd (x, y, z; the force on the first
///   body; of
///                   membranes, whose deflection is along z, in z), Largest Pressure, of order 2 Largest
///                   Penetration (ContactState),
///                   Contact Area (that of the active rows), Note (what a user should know), Bent Nodes (at
///                   sharp bends of a surface
///                   more than one face of which meets the other side: rows with a mean normal). Rows that
///                   contacts share count with
///                   each of them, by area
///   Tied/NAME, and more of Contact/NAME: see JointResults.hpp
///   Body/NAME of elastic bodies: Largest Displacement (the length of the vector), Largest von Mises Stress
/// Sums are the same to the last digit on any number of ranks. Nothing but the numbers in the lists is ever
/// whole on one rank. Collective.
void addResults(const SolvedScene& solved, const Evaluation& evaluation, Teuchos::ParameterList& report);

} // namespace epafi::output
