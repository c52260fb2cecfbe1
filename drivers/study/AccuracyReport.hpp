#pragma once

/// Tables to read, of what the accuracy study has measured.

#include "AccuracyTable.hpp"

namespace epafi::drivers {

/// The default beside the front; order 2 beside order 1; products that balanced stopping and nested starts
/// save; errors of the ladders' meshes with the orders that are observed; what each variant took on the
/// finest mesh of each problem.
std::string accuracyReport(const Table& table);

/// Products that each preconditioner takes for a digit of the iteration.
std::string digitsReport(const Table& table);

} // namespace epafi::drivers
