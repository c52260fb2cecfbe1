#pragma once

/// The least algorithm that solves the problem in the multipliers:
///   no multiplier at all   direct solve, nothing to iterate
///   no contact             conjugate gradients on F (Belos)
///   contact, all supported MPRGP
///   floating bodies        SMALBE with MPRGP inside, on PFP after the shift by λ̃

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <string>

namespace epafi::fetidp {

/// From the least to what bounds and floating bodies together need.
enum class Algorithm { direct, conjugateGradient, mprgp, smalbe };

/// "Direct", "CG", "MPRGP", "SMALBE-M".
std::string toString(Algorithm algorithm);

struct AlgorithmChoice {
  Algorithm algorithm = Algorithm::direct;
  std::string reason; ///< one sentence
};

/// Not collective; the same on all ranks.
AlgorithmChoice leastAlgorithm(const decomposition::DecomposedProblem& problem);

} // namespace epafi::fetidp
