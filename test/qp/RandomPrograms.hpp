#pragma once

/// Random quadratic programs of every kind that a solver has to answer, each from its seed alone.

#include "support/DenseProgram.hpp"

#include <string>

namespace epafi::test {

struct RandomProgram {
  DenseProgram program;
  bool isDegenerate = false;     ///< active bounds without a force
  bool isSingular = false;       ///< A is semidefinite: the solution need not be unique
  double smallestEigenvalue = 1; ///< of A, but for its kernel
  std::string kind;              ///< in words, for a message
};

/// Feasible, with a solution: sizes 1 to 200, condition 1 to 1e10; degenerate, active everywhere or nowhere,
/// fixed entries, without bounds, b = 0, b of noise, A semidefinite; without rows, with rows of full rank,
/// redundant ones, badly scaled ones; in units over 12 orders of magnitude.
RandomProgram randomSolvableProgram(unsigned seed);

/// Crossing bounds, rows that contradict each other, or bounds that leave the rows no solution.
RandomProgram randomInfeasibleProgram(unsigned seed);

/// A feasible program whose objective falls without end along a direction that bounds and rows allow.
RandomProgram randomUnboundedProgram(unsigned seed);

} // namespace epafi::test
