#pragma once

/// A STEP file, by Gmsh's OpenCASCADE kernel.

#include "epafi/assembly/Assembly.hpp"
#include "epafi/assembly/PairSearch.hpp"

#include <string>

namespace epafi::assembly {

/// Rank 0 reads the file and looks for pairs. Collective. \throws InputError, the same on all ranks, if there
/// is no such file, Gmsh refuses it, or it has no solid; Error if Gmsh cannot be loaded
Assembly readAssembly(const std::string& file, const PairSearch& search, const Comm& comm);

} // namespace epafi::assembly
