#pragma once

/// Elastic-plastic torsion of a square bar.

#include "epafi/benchmarks/BoundBenchmark.hpp"

namespace epafi::benchmarks {

/// min ∫ ½ |∇v|² − c v over |v| ≤ distance to the border, v = 0 on the border of (0, 1)²; n × n unknowns, linear
/// elements on triangles. Where |v| is at its bound the bar is plastic; c is twice the shear modulus times the twist.
/// Problem DEPT of MINPACK-2 (Averick, Carter, Moré, Xue, Argonne ANL/MCS-P153-0692, 1992); Moré, Toraldo,
/// *SIAM J. Optim.* 1 (1991); TORSION1 of CUTEst (2Q = n + 2).
/// \param borderWeight  as for `obstacle`: ½ gives CUTEst's matrix
/// \throws InputError if n < 1. Collective.
BoundBenchmark torsion(int n, const RCP<const Comm>& comm, double c = 5, double borderWeight = 1);

} // namespace epafi::benchmarks
