#pragma once

/// The studies of `epafi-study`. Each writes its tables into a directory, small ones if it is to be quick,
/// says which, and returns whether all went as it should. Collective. \throws InputError, Error; the same on
/// all ranks.

#include "epafi/base/Types.hpp"

#include <filesystem>

namespace epafi::drivers {

/// What each digit takes, by mesh, tolerance and method: accuracy.csv, accuracy_effectivity.csv and
/// accuracy.md. Rows of other solvers are added where AccuracyPeers.hpp finds them there. False if a run did
/// not converge.
bool studyAccuracy(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

/// Scenes with a target: true error beside target and estimate, meshes and seconds: targets.csv. False if a
/// true error is more than a tenth above its target.
bool studyTargets(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

/// Local refinement to targets beside even meshes of order 1 and 2: seconds over the true error,
/// refinement.csv.
bool studyRefinement(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

/// Tables 1 and 2 of the paper, dimensions and iterations of the model problem, ours beside the paper's, in
/// 18 cells (quick: those with H/h ≤ 8): tables.csv and tables.md. False if a cell did not converge.
bool studyTables(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

/// What MPRGP's variants, preconditioners and starts cost on problems with bounds, journal bearing, obstacle
/// and torsion with 100², 200² and 400² unknowns (quick: 50² and 100²): qp.csv, qp.md and qp_traffic.csv.
/// False if a run with the default expansion and release did not converge.
bool studyQp(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

/// How time, memory and messages grow with the number of subdomains, their size and the number of ranks:
/// scaling.csv and scaling.md. On one rank: growing 1/H and H/h, forms of F and preconditioners, and, as
/// tables of their own, dense products beside the memory's speed (scaling_blocks.csv), the expectations of
/// the cost model (scaling_costs.csv) and an iteration on up to 10⁵ ranks (scaling_coarse.csv,
/// scaling_prediction.csv). On several ranks: strong and weak scaling; rows of other numbers of ranks that
/// DIR/scaling.csv holds are kept. False if a run did not converge. \throws InputError if DIR/scaling.csv is
/// there and not of this study.
bool studyScaling(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

/// The hard cases of cases/stability.cases, each with its expected outcome: stability.csv and stability.md.
/// Cases run on rank 0 alone while the others sleep, but those that ask for a number of ranks: such run if
/// there are as many. False if an outcome is not as expected.
bool studyStability(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

/// Products with F and condition numbers where the stiffness jumps by up to 10⁶ (quick: 1 and 10⁶ on fewer
/// subdomains), along the cut and across it, without and with adaptive constraints: heterogeneity.csv. False
/// if a run with the defaults did not converge.
bool studyHeterogeneity(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

/// Smallest and largest eigenvalues of F, or PFP, plain and preconditioned, over the size and the number of
/// subdomains: for FETI-DP, of the whole and of its gluing and contact parts, FETI and hybrid; products
/// beside them: spectra.csv and spectra.md. False if a run did not converge or an eigenvalue is not known to
/// 2 %.
bool studySpectra(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

} // namespace epafi::drivers
