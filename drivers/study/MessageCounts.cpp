#include "MessageCounts.hpp"

#include <mpi.h>

namespace {

epafi::drivers::MessageCounts counts; // NOLINT: the calls of MPI have no other place for it

std::int64_t bytesOf(int count, MPI_Datatype type) {
  int size = 0;
  MPI_Type_size(type, &size);
  return std::int64_t{count} * size;
}

void countMessage(int count, MPI_Datatype type) {
  ++counts.messages;
  counts.bytes += bytesOf(count, type);
}

} // namespace

extern "C" {

int MPI_Allreduce(const void* sendbuf, void* recvbuf, int count, MPI_Datatype datatype, MPI_Op op,
                  MPI_Comm comm) {
  int ranks = 0, all = 0;
  MPI_Comm_size(comm, &ranks);
  MPI_Comm_size(MPI_COMM_WORLD, &all);
  if (ranks == all) {
    ++counts.reductions;
    counts.reductionBytes += bytesOf(count, datatype);
  } else if (ranks > 1) {
    ++counts.teamReductions;
  }
  return PMPI_Allreduce(sendbuf, recvbuf, count, datatype, op, comm);
}

int MPI_Allgatherv(const void* sendbuf, int sendcount, MPI_Datatype sendtype, void* recvbuf,
                   const int recvcounts[], const int displs[], MPI_Datatype recvtype, MPI_Comm comm) {
  ++counts.gatherings;
  return PMPI_Allgatherv(sendbuf, sendcount, sendtype, recvbuf, recvcounts, displs, recvtype, comm);
}

int MPI_Send(const void* buf, int count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm) {
  countMessage(count, datatype);
  return PMPI_Send(buf, count, datatype, dest, tag, comm);
}

int MPI_Ssend(const void* buf, int count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm) {
  countMessage(count, datatype);
  return PMPI_Ssend(buf, count, datatype, dest, tag, comm);
}

int MPI_Rsend(const void* buf, int count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm) {
  countMessage(count, datatype);
  return PMPI_Rsend(buf, count, datatype, dest, tag, comm);
}

int MPI_Isend(const void* buf, int count, MPI_Datatype datatype, int dest, int tag, MPI_Comm comm,
              MPI_Request* request) {
  countMessage(count, datatype);
  return PMPI_Isend(buf, count, datatype, dest, tag, comm, request);
}

} // extern "C"

namespace epafi::drivers {

MessageCounts messageCounts() {
  return counts;
}

MessageCounts operator-(const MessageCounts& a, const MessageCounts& b) {
  return {a.messages - b.messages,
          a.bytes - b.bytes,
          a.reductions - b.reductions,
          a.reductionBytes - b.reductionBytes,
          a.teamReductions - b.teamReductions,
          a.gatherings - b.gatherings};
}

} // namespace epafi::drivers
