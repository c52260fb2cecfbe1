#pragma once

/// Messages of this rank, counted by taking the place of MPI's calls (MPI's profiling interface): a program
/// that links this counts whatever Tpetra, Teuchos and Epafi send.

#include <cstdint>

namespace epafi::drivers {

/// Since the program started. Messages are those that this rank sends to another one; what a reduction moves
/// depends on MPI, so its bytes are those of the result.
struct MessageCounts {
  std::int64_t messages = 0, bytes = 0;
  std::int64_t reductions = 0, reductionBytes = 0; ///< over all ranks
  std::int64_t teamReductions = 0;                 ///< over some
  std::int64_t gatherings = 0;                     ///< of values of all ranks on all
};

/// Not collective.
MessageCounts messageCounts();
MessageCounts operator-(const MessageCounts& a, const MessageCounts& b);

} // namespace epafi::drivers
