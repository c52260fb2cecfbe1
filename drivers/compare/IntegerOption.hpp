#pragma once

/// Numbers on the command line of the programs that are compared.

#include "epafi/base/Errors.hpp"

#include <charconv>
#include <string>
#include <system_error>

namespace epafi::drivers {

/// \throws InputError if `text` is no integer or outside least … greatest
inline int integerOption(const std::string& option, const std::string& text, int least, int greatest) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > greatest)
    throw InputError("option " + option + " is '" + text + "'; allowed are the integers " +
                     std::to_string(least) + " ... " + std::to_string(greatest));
  return value;
}

} // namespace epafi::drivers
