#pragma once

/// Pairs of faces in contact, looked for between the meshes of a scene or deck.

#include "epafi/assembly/Assembly.hpp"
#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::drivers {

struct FoundPairs {
  Teuchos::ParameterList contacts; ///< the scene's list Contact, without Automatic
  std::string faces, notes;        ///< a table of all faces, and what was found; lines
  std::string picture;             ///< of the faces, an SVG; on rank 0
};

/// Rank 0 looks. Collective.
/// \param written  the scene of the file
/// \param shows  makes the picture, and says what hinders pairs instead of refusing it
/// \throws InputError, the same on all ranks, for membranes, meshes in several files, and facets that are too
/// coarse to tell
FoundPairs findPairs(const Teuchos::ParameterList& written, const std::string& file, const Comm& comm,
                     bool shows = false);

/// Puts what is found in the place of the list Contact/Automatic, if there is one; returns the notes.
/// Likewise.
std::string takeFoundPairs(Teuchos::ParameterList& written, const std::string& file, const Comm& comm);

/// That of an assembly's faces, for which it is meshed coarsely. Not collective.
std::string pictureOfStep(const std::string& file, const assembly::Assembly& assembly);

} // namespace epafi::drivers
