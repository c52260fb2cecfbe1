#pragma once

/// The values of a data line.

#include "epafi/deck/Cards.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace epafi::deck {

/// A finite number as C or Fortran write it: 1.5, 1.D-3, 0.1-101.
std::optional<double> parsedReal(std::string_view text);
/// A whole number without anything behind it.
std::optional<GlobalOrdinal> parsedWhole(std::string_view text);

/// What stands between the commas of a line. Functions that ask for a field throw InputError, with the line
/// and what should be there, if it is something else.
class Fields {
public:
  Fields(const Card& card, const Line& line);

  /// Without empty ones at the end.
  [[nodiscard]] int size() const { return static_cast<int>(fields_.size()); }
  [[nodiscard]] bool has(int field) const { return field < size() && !fields_[field].empty(); }
  [[nodiscard]] std::string_view operator[](int field) const {
    return has(field) ? fields_[field] : std::string_view();
  }
  [[nodiscard]] std::string name(int field, const char* what) const; ///< upper case, without blanks
  [[nodiscard]] GlobalOrdinal number(int field,
                                     const char* what) const; ///< of a node or an element, from 1 on
  [[nodiscard]] int integer(int field, const char* what) const;
  [[nodiscard]] double real(int field, const char* what) const;
  [[nodiscard]] double realOr(int field, const char* what, double otherwise) const;
  void requireAtMost(int numFields) const;
  [[nodiscard]] const Card& card() const { return *card_; }
  [[nodiscard]] Place place() const { return line_->place(); }
  [[noreturn]] void refuse(const std::string& what) const { card_->refuseAt(place(), what); }

private:
  [[noreturn]] void refuseField(int field, const std::string& should) const;

  const Card* card_;
  const Line* line_;
  std::vector<std::string_view> fields_;
};

/// All numbers of a card, over all of its lines, where a number of values makes a row.
/// \param perRow  values of a row; \param optionalAtEnd  of which so many may be left out at its end
std::vector<std::vector<double>> rowsOf(const Card& card, int perRow, int optionalAtEnd);

/// The six coordinates of two points in one line.
std::pair<Point, Point> twoPoints(const Fields& fields);

} // namespace epafi::deck
