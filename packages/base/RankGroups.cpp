#include "epafi/base/RankGroups.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <algorithm>

namespace epafi {

RankGroups::RankGroups(const RCP<const Comm>& comm, int number)
    : number_(std::clamp(number, 1, comm->getSize())), group_(comm) {
  const int rank = comm->getRank();
  if (number_ == comm->getSize()) {
    leaders_ = comm;
    if (number_ > 1)
      group_ = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
    return;
  }
  if (number_ > 1)
    group_ =
        comm->split(static_cast<int>(static_cast<GlobalOrdinal>(rank) * number_ / comm->getSize()), rank);
  leaders_ = comm->split(leads() ? 0 : -1, rank);
}

bool RankGroups::leads() const {
  return group_->getRank() == 0;
}

} // namespace epafi
