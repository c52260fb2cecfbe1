#pragma once

/// How close a step of MPRGP comes to the speed of the memory.

#include "Table.hpp"

namespace epafi::drivers {

/// Times conjugate gradient steps of MPRGP (the shortest of 100) without their products with the Hessian, and
/// sets the bytes they stream (packages/qp/solve/Mprgp.hpp) over that time against a triad a = b + s c on
/// vectors of the same length. With `quick` only short vectors. Returns qp_traffic.csv: size (unknowns),
/// bytes_per_step, step_seconds, stream_bytes_per_second, ratio. A ratio of 1 is as fast as the triad. It can
/// be more: a triad reads what it is about to overwrite, which nobody counts, while a step mostly reads.
/// Collective.
Table measureTraffic(bool quick, const RCP<const Comm>& comm);

} // namespace epafi::drivers
