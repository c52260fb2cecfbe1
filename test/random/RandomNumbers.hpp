#pragma once

/// Draws that are the same on every platform, from a seed.

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>

namespace epafi::test {

class RandomNumbers {
public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed * 0x9E3779B97F4A7C15ULL + 1) {}

  /// In [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  /// 10 to a power in [low, high).
  double magnitude(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  /// 0, …, count − 1.
  int index(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// One of some values.
  template <class T>
  T oneOf(std::initializer_list<T> values) {
    return *(values.begin() + index(static_cast<int>(values.size())));
  }

private:
  std::mt19937_64 engine_;
};

} // namespace epafi::test
