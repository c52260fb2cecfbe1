#pragma once

/// Column, row and layer of numbers in a row-by-row numbering.

#include "epafi/base/Types.hpp"

namespace epafi::fem {

/// Numbers that follow each other in a row cost no division; others one.
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

/// The same in space, layer by layer. Numbers that follow each other cost a division a row at most; others two.
class BoxWalk {
public:
  /// \param rowLength  numbers a row, ≥ 1
  /// \param rowsPerLayer  rows a layer, ≥ 1
  BoxWalk(GlobalOrdinal rowLength, GlobalOrdinal rowsPerLayer) : inRow_(rowLength), inLayer_(rowsPerLayer) {}

  /// Goes to a number ≥ 0.
  void to(GlobalOrdinal number) {
    inRow_.to(number);
    inLayer_.to(inRow_.row());
  }

  [[nodiscard]] GlobalOrdinal column() const { return inRow_.column(); }
  [[nodiscard]] GlobalOrdinal row() const { return inLayer_.column(); }
  [[nodiscard]] GlobalOrdinal layer() const { return inLayer_.row(); }

private:
  GridWalk inRow_, inLayer_; ///< place in a row of numbers; place in a layer of rows
};

} // namespace epafi::fem
