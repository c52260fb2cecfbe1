#include "epafi/base/EvenShares.hpp"

#include "epafi/base/RawCommunicator.hpp"

#include <Teuchos_Comm.hpp>
#include <mpi.h>

#include <algorithm>
#include <utility>

namespace epafi {

EvenShares::EvenShares(RCP<const Comm> comm, int number) : comm_(std::move(comm)) {
  const GlobalOrdinal ranks = comm_->getSize();
  for (GlobalOrdinal rank = 0; rank < ranks; ++rank) {
    offsets_.push_back(static_cast<int>(rank * number / ranks));
    counts_.push_back(static_cast<int>((rank + 1) * number / ranks) - offsets_.back());
  }
}

int EvenShares::first() const {
  return first(comm_->getRank());
}

int EvenShares::size() const {
  return size(comm_->getRank());
}

void EvenShares::gather(std::span<const double> mine, std::span<double> all) const {
  if (comm_->getSize() == 1)
    std::copy(mine.begin(), mine.end(), all.begin());
  else
    MPI_Allgatherv(mine.data(), size(), MPI_DOUBLE, all.data(), counts_.data(), offsets_.data(), MPI_DOUBLE,
                   rawCommunicator(*comm_));
}

} // namespace epafi
