#pragma once

/// Where things lie that a study uses.

#include <filesystem>

namespace epafi::drivers {

/// The folder that holds this program and its sisters.
std::filesystem::path programDirectory();

/// The scenes of the clone that the program was built in.
std::filesystem::path sceneDirectory();

} // namespace epafi::drivers
