#pragma once

/// scaling.csv: one row a run, kept from one call of the study to the next.

#include "Table.hpp"

namespace epafi::drivers {

/// What runs, and what it took. Times in seconds, the largest over the ranks; bytes of all ranks together
/// unless said otherwise:
///
///   problem coercive, semicoercive: the paper's membranes; blocks: two elastic ones in space
///   (ScalingScene.hpp)
///   H_inverse, H_over_h            1/H, H/h
///   cluster                        subdomains that share crosspoints; 0: a whole body's
///   operator                       of F: implicit, explicit, shared
///   total_seconds                  recovery of u too
///   apply_seconds, apply_bytes     of one product with F, what it reads of factors or blocks
///   stream_bytes_per_second        of the triad
///   messages_per_apply, …          of the rank with most, to its neighbours
///   factor_bytes                   and dense blocks of F; explicit_setup_seconds those alone
///   preconditioner_seconds         one application
///   problem_bytes                  different subdomain matrices, and vectors
///   base_bytes                     held before the run: program and libraries
///   unknowns, multipliers          primal and dual dimension
///   reduction_bytes_per_apply      of one rank; reduction_bytes_per_step of a conjugate gradient step
///   team_reductions_per_step       among ranks that share clusters (CoarseProblem.hpp)
///   gatherings_per_step            of values of all ranks on all
Table scalingTable();

/// A run by its settings, with the shared form of F and the Dirichlet preconditioner.
Row scalingRun(const std::string& problem, int subdomainsPerSide, int elementsPerSide, int ranks = 1);

/// The columns by which a run is the same, with other measurements.
extern const std::vector<std::string> scalingSettings;

/// What an earlier call of the study wrote, without rows of so many ranks; empty if there is no such file.
/// \throws InputError if the file has other columns or an entry that is no number.
Table readScaling(const std::filesystem::path& file, int withoutRanks);

} // namespace epafi::drivers
