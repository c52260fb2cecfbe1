#pragma once

/// What follows from displacements and multipliers, computed once for files and results.

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/simulation/ContactState.hpp"
#include "epafi/simulation/Deformation.hpp"
#include "epafi/simulation/FrictionResults.hpp"
#include "epafi/simulation/JointResults.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace epafi::simulation {

/// Stress at the nodes of body `body`, of this rank's slab (evenShare of the nodes). Linear elements have
/// their stress at their centres; a node has the mean of the elements around it, weighted by their areas or
/// volumes, of every component of the tensor: exact where the stress is constant, O(h²) inside uniform
/// meshes, and the same for every cut and number of ranks but for round-off. Between two materials it is the
/// mean of both sides. Each rank looks at the elements of its own subdomains. Precondition: the body is
/// elastic. Collective.
std::vector<fem::SymmetricTensor> stressesAtNodes(const SolvedScene& solved, int body);

/// Strain likewise, that of temperatures in it; of plane stress without that across the plane.
std::vector<fem::SymmetricTensor> strainsAtNodes(const SolvedScene& solved, int body);

/// Von Mises' norm of stresses at nodes. Likewise.
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

/// The longest displacement of a node of a body; of membranes the largest deflection. Collective.
double largestDisplacement(const SolvedScene& solved, int body);

/// What a body has come to.
struct BodyResult {
  std::string name;
  bool isElastic = false;
  double largestDisplacement = 0; ///< length of the vector; of elastic bodies
  double largestStress = 0;       ///< von Mises', at a node; of elastic bodies
  Deformation deformation;        ///< of elastic bodies
  bool floats = false;            ///< whether its supports leave it a rigid motion
  int parts = 0, askedParts = 0;  ///< subdomains, and those that METIS was asked for; 0: it was not
};

/// Forces on rows that contacts share count with each of them, by area.
struct ContactResult {
  std::string name;
  GlobalOrdinal candidates = 0, activeNodes = 0; ///< rows, and those that are closed
  double force = 0;                              ///< Σλ
  std::array<double, 3> resultant{};             ///< −Σλd on the first body; of membranes in z
  double largestPressure = 0, area = 0;          ///< area of the closed rows
  std::optional<double> penetration;             ///< of order 2: the largest (ContactState)
  GlobalOrdinal numBent = 0; ///< rows at sharp bends that have a mean normal (ContactLayout::numBent)
  std::string note;          ///< what a user should know of it; perhaps empty
  std::optional<JointBalance> balance; ///< of its two sides; nothing of obstacles
  std::optional<FrictionResult> friction;
};

/// Of each body of the scene. Collective.
std::vector<BodyResult> bodyResults(const SolvedScene& solved, const Evaluation& evaluation);

/// Of each contact that is no tied joint. Sums are the same to the last digit on any number of ranks.
/// Collective.
std::vector<ContactResult> contactResults(const SolvedScene& solved, const Evaluation& evaluation);

} // namespace epafi::simulation
