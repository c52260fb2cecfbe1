#pragma once

/// Column, row and layer of numbers in a numbering row by row and layer by layer.

#include "epafi/base/Types.hpp"

#include <array>
#include <cstddef>

namespace epafi::fem {

/// Numbers that follow each other cost a division a row at most; others two.
class GridWalk {
public:
  /// \param rowLength  numbers a row, ≥ 1
  /// \param rowsPerLayer  rows a layer, ≥ 1
  GridWalk(GlobalOrdinal rowLength, GlobalOrdinal rowsPerLayer)
      : rowLength_(rowLength), rowsPerLayer_(rowsPerLayer) {}

  /// Goes to a number ≥ 0.
  void to(GlobalOrdinal number) {
    place_[0] += number - number_;
    number_ = number;
    if (place_[0] < 0 || place_[0] >= rowLength_) {
      const GlobalOrdinal row = number / rowLength_;
      place_[0] = number - row * rowLength_;
      place_[2] = row / rowsPerLayer_;
      place_[1] = row - place_[2] * rowsPerLayer_;
    }
  }

  /// Column, row and layer.
  [[nodiscard]] const std::array<GlobalOrdinal, 3>& place() const { return place_; }
  [[nodiscard]] GlobalOrdinal operator[](std::size_t axis) const { return place_[axis]; }

private:
  GlobalOrdinal rowLength_, rowsPerLayer_;
  GlobalOrdinal number_ = 0;
  std::array<GlobalOrdinal, 3> place_{0, 0, 0};
};

} // namespace epafi::fem
