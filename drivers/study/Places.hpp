#pragma once

/// Where things lie beside the running program, in the build tree as when installed.

#include <filesystem>

namespace epafi::drivers {

/// The folder that holds this program and its sisters.
std::filesystem::path programDirectory();

/// The scenes that come with Epafi.
std::filesystem::path sceneDirectory();

} // namespace epafi::drivers
