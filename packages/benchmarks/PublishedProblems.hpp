#pragma once

/// Problems with bounds from the literature: a membrane on the unit square that is pushed against obstacles,
/// the elastic-plastic torsion of a square bar, and the pressure in a journal bearing, which is nowhere
/// negative.

#include "epafi/benchmarks/BoundBenchmark.hpp"

namespace epafi::benchmarks {

enum class Obstacles {
  below,    ///< v ≥ sin(3.2x) sin(3.3y)
  bothSides ///< s³ ≤ v ≤ s² + 0.02 with s = sin(9.2x) sin(9.3y)
};

/// min ∫ ½ |∇v|² − v over v between the obstacles that vanish on the border of (0, 1)²; n × n unknowns,
/// linear elements on triangles. Dembo, Tulowitzki, *On the minimization of quadratic functions subject to
/// box constraints*, Yale WP 71 (1983); Moré, Toraldo, *SIAM J. Optim.* 1 (1991), problems A and B; OBSTCLAE
/// and OBSTCLBM of CUTEst (PX = PY = n + 2), whose further bound 2000 is never reached.
/// \param borderWeight  weight of the mesh edges that end on the border. CUTEst's files add up the four edges
/// of every unknown with ¼ each and so give them ½; 1 is what the integral says.
/// \throws InputError if n < 1. Collective.
BoundBenchmark obstacle(int n, const RCP<const Comm>& comm, Obstacles obstacles = Obstacles::below,
                        double borderWeight = 1);

/// min ∫ ½ |∇v|² − c v over |v| ≤ distance to the border, v = 0 on the border of (0, 1)²; n × n unknowns,
/// linear elements on triangles. Where |v| is at its bound the bar is plastic; c is twice the shear modulus
/// times the twist. Problem DEPT of MINPACK-2 (Averick, Carter, Moré, Xue, Argonne ANL/MCS-P153-0692, 1992);
/// Moré, Toraldo, *SIAM J. Optim.* 1 (1991); TORSION1 of CUTEst (2Q = n + 2).
/// \param borderWeight  as for `obstacle`: ½ gives CUTEst's matrix
/// \throws InputError if n < 1. Collective.
BoundBenchmark torsion(int n, const RCP<const Comm>& comm, double c = 5, double borderWeight = 1);

/// min ∫ ½ p |∇v|² − ε sin(ξ) v over v ≥ 0 that vanish on the border of (0, 2π) × (0, 2b), p(ξ) = (1 + ε cos
/// ξ)³; n × n unknowns, linear elements on triangles. Problem DPJB of MINPACK-2 (Averick, Carter, Moré, Xue,
/// Argonne ANL/MCS-P153-0692, 1992), discretised as in the example `jbearing2` of PETSc and the tutorial of
/// PERMON:
///
///   t₁ = hx hy (2p(ξ) + p(ξ+hx))/6     t₂ = hx hy (2p(ξ) + p(ξ−hx))/6
///   t₃ = hx hy (p(ξ) + 2p(ξ+hx))/6     t₄ = hx hy (p(ξ) + 2p(ξ−hx))/6
///   south = north = −(t₁+t₂)/hy²,  west = −(t₂+t₄)/hx²,  east = −(t₁+t₃)/hx²,  b = ε hx hy sin ξ
///
/// The elements are hy/hx = b/π times as high as wide: 3.2 with the usual b.
/// \param eccentricity  ε, in (0, 1)
/// \param b             half the height of the domain
/// \throws InputError if n < 1. Collective.
BoundBenchmark journalBearing(int n, const RCP<const Comm>& comm, double eccentricity = 0.1, double b = 10);

} // namespace epafi::benchmarks
