#pragma once

/// The communicator of MPI behind one of Teuchos, for messages that Teuchos does not offer.

#include "epafi/base/Types.hpp"

#include <mpi.h>

namespace epafi {

/// Not collective. Throws Error if `comm` is not one of MPI's; such a one has a single rank, which needs no messages.
MPI_Comm rawCommunicator(const Comm& comm);

/// Σ of the values of the ranks before this one. Teuchos has a scan, which turns a lack of memory into an exception without a
/// word. Collective.
GlobalOrdinal sumBefore(const Comm& comm, GlobalOrdinal mine);

} // namespace epafi
