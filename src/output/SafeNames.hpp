#pragma once

/// Names of groups in files.

#include <string>
#include <vector>

namespace epafi::output {

/// Names that are safe in HDF5 and XDMF paths, one for each name, all different: letters, digits, '_', '-',
/// '.' and anything beyond ASCII stay, every other character ('/', ':', blanks, quotes, …) becomes '_'. A
/// name of dots alone or an empty one becomes "unnamed". Names that would coincide get "_2", "_3", …
std::vector<std::string> safeNames(const std::vector<std::string>& names);

} // namespace epafi::output
