#pragma once

/// The columns of CalculiX' .dat files.

#include "epafi/base/Types.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>

namespace epafi::drivers {

inline std::string inColumns(std::span<const double> values, const char* format = " %13.6E") {
  std::string text;
  std::array<char, 32> number{};
  for (const double value : values) {
    std::snprintf(number.data(), number.size(), format, value);
    text += number.data();
  }
  return text;
}

inline std::string inWidth(GlobalOrdinal number, std::size_t width) {
  const std::string text = std::to_string(number);
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

inline std::string printedRow(GlobalOrdinal number, std::span<const double> values) {
  return inWidth(number, 10) + inColumns(values) + '\n';
}

inline std::string printTitle(const std::string& what, const std::string& time) {
  return "\n " + what + " and time  " + time + "\n\n";
}

} // namespace epafi::drivers
