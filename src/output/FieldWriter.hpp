#pragma once

/// The solution of a scene as files that other programs open.

#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fetidp/ContactSolution.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <filesystem>
#include <string>

namespace epafi::output {

struct FieldFiles {
  std::filesystem::path hdf5;
  std::filesystem::path xdmf;
};

/// Writes `directory`/`name`.h5 and `directory`/`name`.xdmf; creates the directory, replaces older files.
///
/// Datasets (lengths, deflections and forces in the scene's units; each body's nodes appear once):
///  - `/bodies/<body>/points` n×3, `cells` n_e×4 (int64, node numbers, counter-clockwise), `u` n×components,
///    `subdomain` n_e (int32, numbered over all bodies), `crosspoints` m×3 (where they lie, supported ones too);
///  - `/contact/<pair>/points` n×3 (first body's edge), `cells` n×1 (each point one, for viewers),
///    `initial_gap` c, `gap` c − Bu (what remains open), `multiplier` λ_I (force a node, positive pushes
///    apart), `active` (int32, 1 where closed);
///  - `/history/iteration`, `outer`, `step` (int8, the code of the letter s, c, e or p), `projected_gradient`,
///    `constraint_residual`, `objective`, `active_bounds` (int64), `hessian_multiplications`: one entry a step.
/// Groups of bodies and pairs are named as safeNames says (Names.hpp); their attribute `name` is the scene's
/// name. The file itself has attributes `program`, `format` (1), `components`, `energy` and `contact_force`.
///
/// Every rank writes a contiguous slab of each table; nothing of global size lies on one rank. `history` must
/// be the same on all ranks (rank 0's is written). Precondition: `solution` belongs to `decomposition`.
/// Collective. \throws InputError if the directory cannot be made or written to or `name` is empty or
/// contains '/';
///             Error if writing fails; then no incomplete file is left.
FieldFiles writeFields(const std::filesystem::path& directory, const std::string& name,
                       const decomposition::Decomposition& decomposition,
                       const fetidp::ContactSolution& solution, const qp::History& history);

} // namespace epafi::output
