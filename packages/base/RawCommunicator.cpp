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

GlobalOrdinal sumBefore(const Comm& comm, GlobalOrdinal mine) {
  if (comm.getSize() == 1)
    return 0;
  long long sum = 0;
  const long long own = mine;
  MPI_Scan(&own, &sum, 1, MPI_LONG_LONG, MPI_SUM, rawCommunicator(comm));
  return static_cast<GlobalOrdinal>(sum - own);
}

} // namespace epafi
