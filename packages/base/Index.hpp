#pragma once

/// Numbers that know what they count.

#include <concepts>

namespace epafi {

/// A number in one index space, which `Space` names. It is made of an integer and read as one without a word;
/// a number of another space is never taken for it: that does not compile.
template <class Space, std::integral Integer = int>
class Index {
public:
  constexpr Index() noexcept = default;
  constexpr Index(Integer number) noexcept // NOLINT(google-explicit-constructor)
      : number_(number) {}
  template <class Other, class OtherInteger>
  Index(Index<Other, OtherInteger>) = delete;
  constexpr operator Integer() const noexcept { return number_; } // NOLINT(google-explicit-constructor)

private:
  Integer number_ = 0;
};

template <class A, class I, class B, class J>
requires(!std::same_as<A, B>) bool operator==(Index<A, I>, Index<B, J>) = delete;
template <class A, class I, class B, class J>
requires(!std::same_as<A, B>) bool operator<=>(Index<A, I>, Index<B, J>) = delete;

} // namespace epafi
