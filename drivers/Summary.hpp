#pragma once

/// What a finished run tells its user.

#include "SceneRun.hpp"

#include <string>

namespace epafi::drivers {

/// The report in lines for people: problem, algorithm and why, iterations, accuracy, time, memory, status.
std::string summary(const SceneRun& run);

} // namespace epafi::drivers
