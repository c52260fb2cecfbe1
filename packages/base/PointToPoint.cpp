#include "epafi/base/PointToPoint.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/RawCommunicator.hpp"

#include <limits>
#include <string>

namespace epafi {
namespace detail {
namespace {

constexpr int tag = 7301;

} // namespace

void exchange(const Comm& comm, std::span<const Message> outgoing, const std::set<int>& senders,
              const std::function<std::byte*(int, std::size_t)>& place) {
  if (outgoing.empty() && senders.empty())
    return;
  const MPI_Comm raw = rawCommunicator(comm);
  for (const Message& message : outgoing)
    if (message.bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw Error("a message of " + std::to_string(message.bytes.size()) + " bytes to rank " +
                  std::to_string(message.rank) +
                  " is longer than MPI can send; spread the run over more ranks");
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

} // namespace detail

std::set<int> sendersTo(const Comm& comm, const std::set<int>& receivers) {
  std::vector<char> isSentTo(static_cast<std::size_t>(comm.getSize()), 0), sends(isSentTo);
  for (const int rank : receivers)
    isSentTo[static_cast<std::size_t>(rank)] = 1;
  MPI_Alltoall(isSentTo.data(), 1, MPI_CHAR, sends.data(), 1, MPI_CHAR, rawCommunicator(comm));
  std::set<int> senders;
  for (int rank = 0; rank < comm.getSize(); ++rank)
    if (sends[static_cast<std::size_t>(rank)] != 0)
      senders.insert(rank);
  return senders;
}

} // namespace epafi
