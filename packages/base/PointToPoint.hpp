#pragma once

/// Messages between pairs of ranks.

#include "epafi/base/Types.hpp"

#include <Teuchos_Comm.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <type_traits>
#include <vector>

namespace epafi {
namespace detail {

/// A message and the rank that it goes to.
struct Message {
  int rank;
  std::span<const std::byte> bytes;
};

/// Calls place(rank, from, bytes) for each piece of each sender's message, in the order of the ranks, and has
/// it received where that says. \param longest bytes of a piece, less than MPI can count; a message is
/// several where it is longer. The same on all ranks
void exchange(const Comm& comm, std::span<const Message> outgoing, const std::set<int>& senders,
              const std::function<std::byte*(int, std::size_t, std::size_t)>& place,
              std::size_t longest = std::size_t{1} << 30);

} // namespace detail

/// Sends `outgoing`, one message a rank, and returns what the ranks in `senders` send here. Every rank named
/// there must send, and to no other rank may anyone send; a message may be empty. Collective only in that all
/// partners call it.
///
/// \tparam Value  what may be copied byte by byte: numbers, or structs of them
template <class Value>
std::map<int, std::vector<Value>>
exchange(const Comm& comm, const std::map<int, std::vector<Value>>& outgoing, const std::set<int>& senders) {
  static_assert(std::is_trivially_copyable_v<Value> && !std::is_pointer_v<Value>);
  std::vector<detail::Message> messages;
  for (const auto& [rank, values] : outgoing)
    messages.push_back({rank, std::as_bytes(std::span(values))});
  std::map<int, std::vector<Value>> received;
  detail::exchange(comm, messages, senders, [&](int rank, std::size_t from, std::size_t bytes) {
    std::vector<Value>& values = received[rank];
    values.resize((from + bytes + sizeof(Value) - 1) / sizeof(Value));
    return reinterpret_cast<std::byte*>(values.data()) + from;
  });
  return received;
}

/// The ranks that messages go to or come from.
template <class Messages>
std::set<int> ranksOf(const Messages& messages) {
  std::set<int> ranks;
  for (const auto& [rank, message] : messages)
    ranks.insert(rank);
  return ranks;
}

/// The ranks that name this one among those that they send to: a byte between any two. Collective.
std::set<int> sendersTo(const Comm& comm, const std::set<int>& receivers);

/// The same exchange where a rank knows only whom it sends to. What it has for itself stays where it is.
/// Collective.
template <class Value>
std::map<int, std::vector<Value>> deliver(const Comm& comm, std::map<int, std::vector<Value>> outgoing) {
  auto own = outgoing.extract(comm.getRank());
  auto received = exchange(comm, outgoing, sendersTo(comm, ranksOf(outgoing)));
  if (!own.empty())
    received.insert(std::move(own));
  return received;
}

} // namespace epafi
