#pragma once

/// The history of an iteration as a table for spreadsheets and scripts.

#include "epafi/base/Types.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <filesystem>
#include <string>

namespace epafi::output {

/// Comma-separated text with the columns iteration, outer, step (s, c, e or p), projected_gradient,
/// constraint_residual, objective, active_bounds, hessian_multiplications; numbers in the shortest form that
/// reads back exactly. Not collective.
std::string historyTable(const qp::History& history);

/// Writes rank 0's history as a CSV file that appears complete or not at all; creates its directory.
/// Collective. \throws InputError if the directory cannot be made or written to, Error if writing fails.
void writeHistory(const qp::History& history, const std::filesystem::path& file, const Comm& comm);

} // namespace epafi::output
