#pragma once

/// The solution of a scene as files that other programs open.

#include "epafi/output/FileSet.hpp"
#include "epafi/qp/solve/SolveReport.hpp"
#include "epafi/simulation/Evaluation.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace epafi::output {

/// The files that were written.
struct FieldFiles {
  std::filesystem::path hdf5;
  std::filesystem::path xdmf;
};

/// A load step whose fields are in the files.
struct FieldStep {
  std::string name;
  int number = 1; ///< 1, 2, … in the order of the scene
};

/// Writes `directory`/`name`.h5 and `directory`/`name`.xdmf; creates the directory, replaces older files. An
/// XDMF file is never beside an HDF5 file of another call: the older one goes before that is replaced, the
/// new one comes after it.
///
/// Datasets (lengths, deflections, forces and stresses in the scene's units; each body's nodes appear once):
/// - `/bodies/<body>/points` n×3, `cells` n_e×nodes of a cell (int64, node numbers in the order of
/// mesh/Cell.hpp, which is VTK's),
///    `u` n×components, `subdomain` n_e (int32, numbered over all bodies), `crosspoints` m×3 (where they lie,
///    supported
///    ones too in the plane);
///    of elastic bodies `von_mises` n (vonMisesAtNodes), and of plane ones `displacement` n×3: u with a third
///    column of
///    zeros, which viewers take as a vector (in space that is u itself);
///    attributes `name`, `cell_type` (as mesh::toString says) and `physics` (as fem::toString says);
///  - `/contact/<pair>/points` n×3 (nodes of the first body's surface), `cells` m×2, 3 or 4, of order 2 3, 6
///  or 9 (that surface's edges or
///    faces, by rows; which, the attribute `cell_type` says; n×1, each point one, for pairs of membranes'
///    edges), `normal` n×3 (of length 1, towards the other side; of
///    membranes z), `area` n (each node's share of the surface; of plane bodies length times thickness, of
///    axisymmetric ones that of the whole circumference, of
///    membranes
///    length), `initial_gap` c, `gap` c − Bu (what remains open), `multiplier` λ_I (force a node, positive
///    pushes apart),
///    `pressure` λ_I/area, `active` (int32, 1 where closed); the force on the first body, whose group the
///    attribute `first_body` names, is −λ_I `normal`;
///  - `/history/iteration`, `outer`, `step` (int8, the code of the letter s, c, e or p),
///  `projected_gradient`,
///    `constraint_residual`, `objective`, `active_bounds` (int64), `hessian_multiplications`: one entry a
///    step.
/// Groups of bodies, pairs and steps are named as safeNames says; their attribute `name` is the scene's
/// name. The file itself has attributes `program`, `format` (1), `components`, `energy` and `contact_force`.
///
/// Of a scene in load steps `/steps/<step>` has all this of each, with the attributes `name`, `number`,
/// `energy` and `contact_force`, and the file itself has the last one's by other names of the same datasets.
/// What no step changes (points, cells, `subdomain`, `crosspoints`, `normal`, `area`) is there once.
///
/// Every rank writes a contiguous slab of each table; nothing of global size lies on one rank. `history` must
/// be the same on all ranks (rank 0's is written). Precondition: `evaluation` is that of `solved`.
/// Collective. \throws InputError if the directory cannot be made or written to or `name` is empty or
/// contains '/';
///             Error if writing fails; then no incomplete file is left.
FieldFiles writeFields(const std::filesystem::path& directory, const std::string& name,
                       const simulation::SolvedScene& solved, const simulation::Evaluation& evaluation,
                       const qp::History& history);
/// The same, for files that get their names with others of `together`, of which there is none if it throws.
/// \param steps  the load steps whose fields are in the files then, the solution's as the last one; those
/// before are in the HDF5 file that is there, which is copied, without any other steps. None: the scene has
/// no steps.
/// \param older  the HDF5 file with those before, if it is another one than that which is there
FieldFiles writeFields(const std::filesystem::path& directory, const std::string& name,
                       const simulation::SolvedScene& solved, const simulation::Evaluation& evaluation,
                       const qp::History& history, FileSet& together,
                       const std::vector<FieldStep>& steps = {}, const std::filesystem::path& older = {});

} // namespace epafi::output
