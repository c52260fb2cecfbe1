#pragma once

/// How fast the memory is, and dense symmetric products beside it.

#include "Table.hpp"

namespace epafi::drivers {

/// Bytes a second of the triad a = b + s c on all ranks together: 3 numbers an entry, what the processor
/// reads to overwrite it not counted. Median of several runs. Collective.
/// \param bytes  of the three arrays together on all ranks; far more than the caches hold
double streamBandwidth(const Comm& comm, double bytes);

/// scaling_blocks.csv: y = A x with a dense symmetric n × n matrix, by one of three kernels: dgemv (full),
/// dspmv (half, packed), dgemm (full, 8 vectors at once); seconds a vector, bytes a second of the matrix.
/// From blocks that take so many bytes together, on this rank alone; medians. Not collective.
Table timeBlockProducts(double bytes, double streamRate);

} // namespace epafi::drivers
