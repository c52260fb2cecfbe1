#pragma once

/// Load steps that are done as text, exactly, and back: what checkpoints have of them.

#include "epafi/simulation/StepsDone.hpp"

#include <string>
#include <string_view>

namespace epafi::output {

/// In lines, each with a number or the bytes of a text, its length before them; but for
/// StepsDone::changesRows, which depends on the step to come. Not collective.
std::string stepsText(const simulation::StepsDone& done);

/// Not collective. \throws InputError, "holds load steps that cannot be read", for what is no such text, or
/// has no step; takes no more memory than a multiple of its length.
simulation::StepsDone stepsOf(std::string_view text);

} // namespace epafi::output
