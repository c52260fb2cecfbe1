#pragma once

/// A membrane on the unit square that is pushed against obstacles.

#include "epafi/benchmarks/BoundBenchmark.hpp"

namespace epafi::benchmarks {

enum class Obstacles {
  below,    ///< v ≥ sin(3.2x) sin(3.3y)
  bothSides ///< s³ ≤ v ≤ s² + 0.02 with s = sin(9.2x) sin(9.3y)
};

/// min ∫ ½ |∇v|² − v over v between the obstacles that vanish on the border of (0, 1)²; n × n unknowns, linear
/// elements on triangles. Dembo, Tulowitzki, *On the minimization of quadratic functions subject to box constraints*,
/// Yale WP 71 (1983); Moré, Toraldo, *SIAM J. Optim.* 1 (1991), problems A and B; OBSTCLAE and OBSTCLBM of CUTEst
/// (PX = PY = n + 2), whose further bound 2000 is never reached.
/// \param borderWeight  weight of the mesh edges that end on the border. CUTEst's files add up the four edges of every
///                      unknown with ¼ each and so give them ½; 1 is what the integral says.
/// \throws InputError if n < 1. Collective.
BoundBenchmark obstacle(int n, const RCP<const Comm>& comm, Obstacles obstacles = Obstacles::below,
                        double borderWeight = 1);

} // namespace epafi::benchmarks
