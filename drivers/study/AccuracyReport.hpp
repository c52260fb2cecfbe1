#pragma once

/// Tables to read, of what the accuracy study has measured.

#include "AccuracyTable.hpp"

#include <string>

namespace epafi::drivers {

/// Errors of the ladder's meshes, with the orders that are observed.
std::string convergenceReport(const AccuracyTable& table);

/// What each variant took on the finest mesh of each problem.
std::string variantsReport(const AccuracyTable& table);

/// How far the default is from the front, problem by problem and mesh by mesh.
std::string frontReport(const AccuracyTable& table);

/// Products that balanced stopping saves beside the default.
std::string balanceReport(const AccuracyTable& table);

/// What the nested start saves on the last mesh, beside a balanced run on that mesh alone.
std::string nestedReport(const AccuracyTable& table);

/// Products that each preconditioner takes for a digit of the iteration.
std::string digitsReport(const AccuracyTable& table);

} // namespace epafi::drivers
