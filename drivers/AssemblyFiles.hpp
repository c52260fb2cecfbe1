#pragma once

/// What the program does where its scene is a STEP file: reads it with what completes it, lists, export.

#include "Options.hpp"

#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::drivers {

struct GivenScene {
  Teuchos::ParameterList list; ///< of a STEP file or deck, as a scene file would have it
  std::string notes;           ///< lines that a user should see
};

/// The scene that the command line names, with its overrides. Collective. \throws InputError, the same on all
/// ranks
GivenScene readGiven(const Options& options, const Comm& comm);

/// What --list and --print-pairs print. Likewise.
std::string listOf(const Options& options, const Comm& comm);

/// Writes a picture of the faces. Collective. \throws InputError as readGiven, or if the file's name does not
/// end in .svg, Error if it cannot be written
void showFaces(const Options& options, const RCP<const Comm>& comm);

/// Writes a STEP file and what completes it as one scene. Collective. \throws InputError as readGiven, or if
/// the file's name does not end in .xml, Error if it cannot be written
void exportAssembly(const Options& options, const RCP<const Comm>& comm);

} // namespace epafi::drivers
