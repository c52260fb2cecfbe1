#pragma once

/// Mesh files of Gmsh without Gmsh: the formats 2.2 and 4.1 (and 2 and 2.1, which are 2.2 but for partitions), in text or
/// binary. Whatever the bytes, they are read or refused: nothing is taken for granted, since files get cut off and damaged.

#include "epafi/fem/GmshContents.hpp"

#include <string>

namespace epafi::fem {

/// What the text of a mesh file says. It is all in memory, and what is made of it takes about twice as much again. Sections
/// other than those of names, entities, nodes and elements are passed over.
///
/// \param name  the file's name, for errors
/// \throws InputError that names file and line (or byte) if the text is not in one of these formats, promises more than it
///         holds, has sections twice or too few, an element that is not linear or whose nodes are not there, or none of
///         dimension 2 or 3
GmshContents readMsh(const std::string& name, std::string text);

} // namespace epafi::fem
