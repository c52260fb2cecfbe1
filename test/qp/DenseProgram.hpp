#pragma once

#include "epafi/benchmarks/DenseProgram.hpp"

namespace epafi::test {

using benchmarks::DenseProgram;
using benchmarks::DenseResiduals;
using benchmarks::Real;
using benchmarks::RealMatrix;
using benchmarks::RealVector;

} // namespace epafi::test
