#pragma once

/// Which Epafi this is.

namespace epafi {

/// "0.1.0": the version of the library that is linked, as CMake's project() names it. Not collective.
const char* version();

} // namespace epafi
