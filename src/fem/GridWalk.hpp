#pragma once

/// Column and row of numbers in a row-by-row numbering.

#include "epafi/base/Types.hpp"

namespace epafi::fem {

/// Numbers that follow each other cost no division; others one.
class GridWalk {
public:
  /// \param rowLength  numbers a row, ≥ 1
  explicit GridWalk(GlobalOrdinal rowLength) : rowLength_(rowLength) {}

  /// Goes to a number ≥ 0.
  void to(GlobalOrdinal number) {
    column_ += number - number_;
    number_ = number;
    if (column_ < 0 || column_ >= rowLength_) {
      row_ = number / rowLength_;
      column_ = number - row_ * rowLength_;
    }
  }

  [[nodiscard]] GlobalOrdinal column() const { return column_; }
  [[nodiscard]] GlobalOrdinal row() const { return row_; }

private:
  GlobalOrdinal rowLength_;
  GlobalOrdinal number_ = 0, column_ = 0, row_ = 0;
};

} // namespace epafi::fem
