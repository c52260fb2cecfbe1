#pragma once

/// The communicator of MPI behind one of Teuchos, for messages that Teuchos does not offer.

#include "epafi/base/Types.hpp"

#include <mpi.h>

namespace epafi {

/// Not collective. Throws Error if `comm` is not one of MPI's; such a one has a single rank, which needs no
/// messages.
MPI_Comm rawCommunicator(const Comm& comm);

} // namespace epafi
