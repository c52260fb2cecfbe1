#pragma once

/// The report of a run, and the history of its iteration, as files that appear complete or not at all.

#include "epafi/base/Types.hpp"
#include "epafi/output/FileSet.hpp"
#include "epafi/qp/solve/SolveReport.hpp"

#include <Teuchos_ParameterList.hpp>

#include <filesystem>

namespace epafi::output {

/// Writes rank 0's list as Teuchos XML; its directory is created.
/// Collective. \throws InputError if the directory cannot be made or written to, Error if writing fails.
void writeReport(const Teuchos::ParameterList& report, const std::filesystem::path& file, const Comm& comm);
/// The same, for a file that gets its name with others.
void writeReport(const Teuchos::ParameterList& report, const std::filesystem::path& file, FileSet& together);

/// Writes rank 0's history as comma-separated text with the columns iteration, outer, step (s, c, e or p),
/// projected_gradient, constraint_residual, objective, active_bounds, hessian_multiplications; numbers in the
/// shortest form that reads back exactly. Directory, collectivity and errors as above.
void writeHistory(const qp::History& history, const std::filesystem::path& file, const Comm& comm);
/// The same, for a file that gets its name with others.
void writeHistory(const qp::History& history, const std::filesystem::path& file, FileSet& together);

} // namespace epafi::output
