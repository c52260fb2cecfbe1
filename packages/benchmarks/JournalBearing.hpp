#pragma once

/// The pressure in a journal bearing, which is nowhere negative.

#include "epafi/benchmarks/BoundBenchmark.hpp"

namespace epafi::benchmarks {

/// min ∫ ½ p |∇v|² − ε sin(ξ) v over v ≥ 0 that vanish on the border of (0, 2π) × (0, 2b), p(ξ) = (1 + ε cos ξ)³;
/// n × n unknowns, linear elements on triangles. Problem DPJB of MINPACK-2 (Averick, Carter, Moré, Xue, Argonne
/// ANL/MCS-P153-0692, 1992), discretised as in the example `jbearing2` of PETSc and the tutorial of PERMON:
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
