#pragma once

/// Records that go to the ranks they are meant for, of which these do not know beforehand.

#include "epafi/base/Types.hpp"

#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace epafi {

/// `count` records of `size` bytes each, record k to rank ranks[k]; the records that came here, sender by
/// sender in ascending order, each sender's in the order in which it gave them. Collective.
std::vector<char> sendRecordBytes(const RCP<const Comm>& comm, const char* records, std::size_t size,
                                  std::span<const int> ranks);

/// The same for values of any type that may be copied byte by byte. Collective.
template <class Record>
std::vector<Record> sendRecords(const RCP<const Comm>& comm, std::span<const Record> records,
                                std::span<const int> ranks) {
  static_assert(std::is_trivially_copyable_v<Record>);
  const std::vector<char> bytes =
      sendRecordBytes(comm, reinterpret_cast<const char*>(records.data()), sizeof(Record), ranks);
  std::vector<Record> received(bytes.size() / sizeof(Record));
  if (!received.empty())
    std::memcpy(received.data(), bytes.data(), bytes.size());
  return received;
}

} // namespace epafi
