#include "epafi/base/PointToPoint.hpp"

#include "epafi/base/RawCommunicator.hpp"

#include <algorithm>

namespace epafi {
namespace detail {
namespace {

constexpr int tag = 7301;

} // namespace

void exchange(const Comm& comm, std::span<const Message> outgoing, const std::set<int>& senders,
              const std::function<std::byte*(int, std::size_t, std::size_t)>& place, std::size_t longest) {
  if (outgoing.empty() && senders.empty())
    return;
  const MPI_Comm raw = rawCommunicator(comm);
  std::vector<MPI_Request> requests;
  for (const Message& message : outgoing)
    for (std::size_t from = 0; from <= message.bytes.size();
         from += longest) { // the last piece is shorter than the others
      const auto piece = message.bytes.subspan(from).first(std::min(longest, message.bytes.size() - from));
      MPI_Isend(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, message.rank, tag, raw,
                &requests.emplace_back());
    }
  for (const int rank : senders) {
    std::size_t from = 0;
    int length = 0;
    do {
      MPI_Status status;
      MPI_Probe(rank, tag, raw, &status);
      MPI_Get_count(&status, MPI_BYTE, &length);
      MPI_Recv(place(rank, from, length), length, MPI_BYTE, rank, tag, raw, MPI_STATUS_IGNORE);
      from += length;
    } while (static_cast<std::size_t>(length) == longest);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

} // namespace detail

std::set<int> sendersTo(const Comm& comm, const std::set<int>& receivers) {
  std::vector<char> isSentTo(comm.getSize(), 0), sends(isSentTo);
  for (const int rank : receivers)
    isSentTo[rank] = 1;
  MPI_Alltoall(isSentTo.data(), 1, MPI_CHAR, sends.data(), 1, MPI_CHAR, rawCommunicator(comm));
  std::set<int> senders;
  for (int rank = 0; rank < comm.getSize(); ++rank)
    if (sends[rank] != 0)
      senders.insert(rank);
  return senders;
}

} // namespace epafi
