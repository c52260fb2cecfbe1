#pragma once

/// How fast the memory is, and dense symmetric products beside it.

#include "epafi/base/Types.hpp"

#include <vector>

namespace epafi::drivers {

/// Bytes a second of the triad a = b + s c on all ranks together: 3 numbers an entry, what the processor reads to
/// overwrite it not counted. Median of several runs. Collective.
/// \param bytes  of the three arrays together on all ranks; far more than the caches hold
double streamBandwidth(const Comm& comm, double bytes);

/// y = A x with a dense symmetric n × n matrix, by one of three kernels.
struct BlockProduct {
  int size = 0;              ///< n
  const char* kernel;        ///< dgemv (full), dspmv (half, packed), dgemm (full, 8 vectors at once)
  double seconds = 0;        ///< a vector
  double bytesPerSecond = 0; ///< of the matrix
};

/// One core alone; medians of several passes over different matrices that fill `bytes` together, so that each is read
/// from the memory, as in a product with F. Not collective.
std::vector<BlockProduct> timeBlockProducts(double bytes);

} // namespace epafi::drivers
