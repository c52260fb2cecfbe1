#pragma once

/// The head of a checkpoint file: lines of text that say what follows.

#include "epafi/output/Fingerprint.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace epafi::output {

/// Begins "Epafi checkpoint 1" and ends with an empty line.
std::string checkpointHeader(const Fingerprint& fingerprint);

/// No header is longer.
constexpr std::size_t longestCheckpointHeader = 1024;

struct ParsedHeader {
  Fingerprint fingerprint;
  std::size_t length = 0; ///< of the text, the empty line included
};

/// Takes nothing but what checkpointHeader() writes, with any numbers.
/// \param text  the beginning of a file
/// \throws InputError that says what is wrong, without the file's name: "is no checkpoint of Epafi". Not collective.
ParsedHeader parseCheckpointHeader(std::string_view text);

/// Fowler, Noll, Vo: FNV-1a, 64 bits, over pieces one after the other.
class Checksum {
public:
  void add(const void* bytes, std::size_t size) {
    const auto* next = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < size; ++i)
      value_ = (value_ ^ next[i]) * 0x100000001b3ULL;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

} // namespace epafi::output
