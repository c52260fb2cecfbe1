#include "epafi/base/PointToPoint.hpp"

#include "epafi/base/RawCommunicator.hpp"

namespace epafi::detail {
namespace {

constexpr int tag = 7301;

} // namespace

void exchange(const Comm& comm, std::span<const Message> outgoing, const std::set<int>& senders,
              const std::function<std::byte*(int, std::size_t)>& place) {
  if (outgoing.empty() && senders.empty())
    return;
  const MPI_Comm raw = rawCommunicator(comm);
  std::vector<MPI_Request> requests(outgoing.size());
  for (std::size_t i = 0; i < outgoing.size(); ++i)
    MPI_Isend(outgoing[i].bytes.data(), static_cast<int>(outgoing[i].bytes.size()), MPI_BYTE,
              outgoing[i].rank, tag, raw, &requests[i]);
  for (const int rank : senders) {
    MPI_Status status;
    int length = 0;
    MPI_Probe(rank, tag, raw, &status);
    MPI_Get_count(&status, MPI_BYTE, &length);
    MPI_Recv(place(rank, static_cast<std::size_t>(length)), length, MPI_BYTE, rank, tag, raw,
             MPI_STATUS_IGNORE);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

} // namespace epafi::detail
