#pragma once

/// What a finished run tells its user.

#include "epafi/simulation/RunResult.hpp"

#include <string>

namespace epafi::drivers {

/// A result in lines for people: problem, algorithm and why, iterations, accuracy, time, memory, status.
std::string summary(const simulation::RunResult& result);

/// One line about a mesh of a run with an accuracy target, ends with a newline.
std::string describe(const accuracy::MeshResult& mesh);

/// A line of a load step.
std::string describe(const simulation::StepResult& step);

} // namespace epafi::drivers
