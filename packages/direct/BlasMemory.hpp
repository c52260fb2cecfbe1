#pragma once

/// The memory that the BLAS takes for itself.

namespace epafi::direct {

/// Makes the BLAS take its work space now. OpenBLAS does so at its first product, 128 MiB of addresses, keeps it, and if there is
/// no such memory, asks for it for ever: a rank short of memory would hang there. So it is asked for here first.
/// \throws std::bad_alloc if it is not to be had. Not collective.
void takeBlasMemory();

} // namespace epafi::direct
