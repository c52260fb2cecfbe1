#pragma once

/// Mesh files on all ranks alike.

#include "epafi/base/Types.hpp"
#include "epafi/meshing/GmshFile.hpp"

#include <functional>
#include <string>

namespace epafi::meshing {

/// Rank 0's text on all ranks, however long. Collective.
void broadcastText(const Comm& comm, std::string& text);

/// What rank 0 makes, on all ranks. Collective. \throws what `makeText` throws, the same on all ranks.
std::string textOnAllRanks(const std::function<std::string()>& makeText, const Comm& comm);

/// Rank 0 makes the text of a file (of a geometry, by meshing it) and hands it to the others: they all have
/// the same mesh, whatever Gmsh does on their machines. \param file its name, for errors. Collective. \throws
/// what `makeText` throws, and readMsh(), the same on all ranks.
GmshFile meshOnAllRanks(const std::string& file, const std::function<std::string()>& makeText,
                        const Comm& comm);

} // namespace epafi::meshing
