#include "epafi/base/RawCommunicator.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

namespace epafi {

MPI_Comm rawCommunicator(const Comm& comm) {
  const auto* mpi = dynamic_cast<const Teuchos::MpiComm<int>*>(&comm);
  if (mpi == nullptr)
    throw Error("messages between ranks need a communicator of MPI");
  return *mpi->getRawMpiComm();
}

} // namespace epafi
