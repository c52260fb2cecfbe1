#pragma once

#include "epafi/benchmarks/DenseProgram.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::test {

using benchmarks::DenseProgram;
using benchmarks::DenseResiduals;
using benchmarks::Real;
using benchmarks::RealMatrix;
using benchmarks::RealVector;

/// The largest absolute value of a bound; 0 without bounds.
inline double largestBound(const DenseProgram& program) {
  double largest = 0;
  for (Eigen::Index i = 0; i < program.size(); ++i)
    for (const double bound : {program.lower[i], program.upper[i]})
      if (std::isfinite(bound))
        largest = std::max(largest, std::abs(bound));
  return largest;
}

} // namespace epafi::test
