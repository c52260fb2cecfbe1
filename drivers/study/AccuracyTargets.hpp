#pragma once

/// What runs that are asked for an accuracy make of it: the true error beside the target and the estimate.

#include "Table.hpp"

namespace epafi::drivers {

/// targets.csv: a scene with a target. Errors in the energy norm, relative; seconds of all meshes, and those
/// of the last.
Table targetsTable();

/// Of scenes/name.xml, for each target; `reference` is that of the run that these are compared with. A target
/// of which that is not clearly better, for lack of memory, has no row.
/// \param order  of the elements, 0: chosen
/// Collective. \throws InputError if the scene cannot be read.
std::vector<Row> measureTargets(const std::string& name, int order, const std::vector<double>& targets,
                                double reference, const std::filesystem::path& scenes,
                                const RCP<const Comm>& comm);

/// s of true_error ~ unknowns^-s, by least squares. Precondition: two rows at least that differ in unknowns.
double fittedOrder(const std::vector<Row>& rows);

/// To read.
std::string targetsReport(const Table& table);

} // namespace epafi::drivers
