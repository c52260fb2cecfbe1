#pragma once

/// What local refinement to a target costs beside even meshes: true errors over the seconds of everything.

#include "Table.hpp"

#include <Teuchos_ParameterList.hpp>

namespace epafi::drivers {

/// refinement.csv: a run of a scene. Errors in the energy norm, relative; `reference_error`, what is
/// estimated of the reference's own, is contained in them. Seconds from the scene to displacements and
/// estimate, of all meshes.
Table refinementTable();

/// Of scenes/name.xml, the medians of runs in turns. A case says: Reference, the target of the run that all
/// are compared with; Targets, of local refinement; Sizes, of even meshes of order 1 and 2, as factors on the
/// scene's element sizes; Repeats. Collective. \throws InputError if the scene cannot be read, Error if a run
/// does not converge.
std::vector<Row> measureRefinement(const std::string& name, const Teuchos::ParameterList& list,
                                   const std::filesystem::path& scenes, const RCP<const Comm>& comm);

} // namespace epafi::drivers
