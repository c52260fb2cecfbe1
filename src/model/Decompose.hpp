#pragma once

/// From a scene to a DecomposedProblem: a scene is an application like others, which meshes bodies, cuts and
/// assembles them, and hands over subdomains and a contact matrix.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/model/BodyLayout.hpp"
#include "epafi/model/PreloadSections.hpp"
#include "epafi/scene/Scene.hpp"

#include <string>
#include <vector>

namespace epafi::model {

/// The scene cut into subdomains: where everything lies (for output), the problem itself (for FETI-DP), and
/// the loads, supports and gaps that the scene gives it, which may change from one solve to the next.
struct Decomposition {
  std::vector<BodyLayout> bodies;
  std::vector<contact::ContactLayout> contacts;
  std::vector<contact::ContactLayout> ties;
  std::vector<contact::Equation> equations; ///< their rows follow those of ties
  std::vector<PreloadSection> sections;     ///< of bolts; their rows are among equations
  decomposition::DecomposedProblem problem;
  decomposition::ProblemData data;
};

/// Cuts the scene into subdomains, gives each rank a contiguous run of them and assembles them.
/// Collective. \throws InputError (the same on all ranks) if contact edges do not match, or if a contact edge
/// is supported.
Decomposition decompose(const scene::Scene& scene, const RCP<const Comm>& comm,
                        Meshes meshes = Meshes::whole);

/// The same of bodies that are meshed and cut already, on all ranks alike. Where the scene says how many
/// parts share crosspoints, that holds instead of BodyLayout::cluster, by which they were dealt out.
Decomposition decompose(const scene::Scene& scene, std::vector<BodyLayout> bodies,
                        const RCP<const Comm>& comm);

/// The modes come from geometry and supports, K from integrals: one proves the other. One product a mode.
/// \param r  R^s, n_s × modes  \param body  its name
/// \throws Error if K^s R^s does not vanish.
void requireKernel(const decomposition::SparseMatrix& k, const Eigen::MatrixXd& r, const std::string& body);

} // namespace epafi::model
