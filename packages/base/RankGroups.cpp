#include "epafi/base/RankGroups.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>

namespace epafi {

RankGroups::RankGroups(const RCP<const Comm>& comm, int number)
    : number_(std::min(number, comm->getSize())), group_(comm) {
  const int rank = comm->getRank();
  if (number_ > 1)
    group_ =
        comm->split(static_cast<int>(static_cast<GlobalOrdinal>(rank) * number_ / comm->getSize()), rank);
  if (number_ == comm->getSize())
    leaders_ = comm;
  else if (const RCP<const Comm> alike = comm->split(leads() ? 0 : 1, rank); leads())
    leaders_ = alike;
}

bool RankGroups::leads() const {
  return group_->getRank() == 0;
}

} // namespace epafi
