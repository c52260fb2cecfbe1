#pragma once

/// Signed numbers as indices of the standard library's containers.

#include <concepts>
#include <cstddef>

namespace epafi {

/// \param number  not negative
template <std::integral Integer>
constexpr std::size_t index(Integer number) noexcept {
  return static_cast<std::size_t>(number);
}

} // namespace epafi
