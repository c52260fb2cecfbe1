#pragma once

/// How near the estimated discretisation error is to the true one, on the scenes of xml/.

#include "Table.hpp"

namespace epafi::drivers {

/// accuracy_effectivity.csv: a scene on one of its meshes. Level 0 is the scene's own mesh, or a coarser one,
/// 1 that mesh refined. Errors in the energy norm relative to that of the solution; that of the reference is
/// contained in the true one.
Table effectivityTable();

/// Of the mesh of scenes/name.xml and of that refined once, beside that refined twice, whose own error is
/// added by extrapolation (AccuracyReference.hpp). Scenes that are too large for that stand beside the last
/// mesh of a run to a target, whose own error is added as the run estimates it.
/// \param target    of such a run; 0: refined twice
/// \param meshSize  factor on the sizes that a geometry asks for
/// Collective. \throws InputError if the scene cannot be read, Error if an iteration does not converge.
std::vector<Row> measureEffectivity(const std::string& name, double target, double meshSize,
                                    const std::filesystem::path& scenes, const RCP<const Comm>& comm);

/// To read.
std::string effectivityReport(const Table& table);

} // namespace epafi::drivers
