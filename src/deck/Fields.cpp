#include "epafi/deck/Fields.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace epafi::deck {
namespace {

constexpr int valuesPerLine = 8;

} // namespace

std::optional<double> parsedReal(std::string_view text) {
  constexpr std::size_t longest = 100;
  if (text.empty() || text.size() > longest)
    return std::nullopt;
  std::string number(text);
  bool hasExponent = false;
  for (char& letter : number)
    if (letter == 'D' || letter == 'd' || letter == 'E' || letter == 'e') {
      letter = 'e';
      hasExponent = true;
    }
  const std::size_t sign = number.find_last_of("+-");
  if (!hasExponent && sign != std::string::npos && sign > 0)
    number.insert(sign, 1, 'e'); // Fortran leaves it out where the exponent has three digits
  const std::size_t exponent = number.find("e+");
  if (exponent != std::string::npos)
    number.erase(exponent + 1, 1);
  double value = 0;
  const char* const end = number.data() + number.size();
  const auto [stop, error] = std::from_chars(number.data() + (number.front() == '+' ? 1 : 0), end, value);
  return error == std::errc() && stop == end && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<GlobalOrdinal> parsedWhole(std::string_view text) {
  GlobalOrdinal value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
  return error == std::errc() && stop == end && !text.empty() ? std::optional(value) : std::nullopt;
}

Fields::Fields(const Card& card, const Line& line) : card_(&card), line_(&line) {
  std::string_view rest = line.text;
  while (!rest.empty()) {
    const std::size_t length = std::min(rest.find(','), rest.size());
    fields_.push_back(withoutBlanks(rest.substr(0, length)));
    rest.remove_prefix(std::min(length + 1, rest.size()));
  }
  while (!fields_.empty() && fields_.back().empty())
    fields_.pop_back();
}

void Fields::refuseField(int field, const std::string& should) const {
  refuse("value " + std::to_string(field + 1) + " of the line should be " + should + ", not " +
         (has(field) ? '"' + shortened(std::string(fields_[field])) + '"' : "left out"));
}

std::string Fields::name(int field, const char* what) const {
  if (!has(field))
    refuseField(field, what);
  return squeezed(fields_[field]);
}

GlobalOrdinal Fields::number(int field, const char* what) const {
  const std::optional<GlobalOrdinal> value = parsedWhole((*this)[field]);
  if (!value || *value < 1)
    refuseField(field, "the number of " + std::string(what));
  return *value;
}

int Fields::integer(int field, const char* what) const {
  const std::optional<GlobalOrdinal> value = parsedWhole((*this)[field]);
  constexpr int most = std::numeric_limits<int>::max();
  if (!value || *value > most || *value < -most)
    refuseField(field, what);
  return static_cast<int>(*value);
}

double Fields::real(int field, const char* what) const {
  const std::optional<double> value = parsedReal((*this)[field]);
  if (!value)
    refuseField(field, what);
  return *value;
}

double Fields::realOr(int field, const char* what, double otherwise) const {
  return has(field) ? real(field, what) : otherwise;
}

void Fields::requireAtMost(int numFields) const {
  if (size() > numFields)
    refuse("the line has " + std::to_string(size()) + " values, of which " + std::to_string(numFields) +
           " have a meaning; take the others out");
}

std::vector<std::vector<double>> rowsOf(const Card& card, int perRow, int optionalAtEnd) {
  const int linesPerRow = (perRow + valuesPerLine - 1) / valuesPerLine;
  std::vector<std::vector<double>> rows;
  for (int l = 0; l < std::ssize(card.data); ++l) {
    const Fields fields(card, card.data[l]);
    const int part = l % linesPerRow;
    const int asked = std::min(valuesPerLine, perRow - part * valuesPerLine);
    fields.requireAtMost(asked);
    if (part == 0)
      rows.emplace_back();
    for (int i = 0; i < asked; ++i)
      if (part * valuesPerLine + i < perRow - optionalAtEnd)
        rows.back().push_back(fields.real(i, "a number"));
      else
        rows.back().push_back(fields.realOr(i, "a number", 0));
  }
  if (rows.empty() || std::ssize(rows.back()) < perRow)
    card.refuse("a row of it has " + std::to_string(perRow - optionalAtEnd) + " numbers, in " +
                std::to_string(linesPerRow) + (linesPerRow == 1 ? " line" : " lines") + "; some are missing");
  return rows;
}

std::pair<Point, Point> twoPoints(const Fields& fields) {
  fields.requireAtMost(6);
  std::pair<Point, Point> points;
  for (int i = 0; i < 3; ++i) {
    points.first[i] = fields.realOr(i, "a coordinate", 0);
    points.second[i] = fields.realOr(3 + i, "a coordinate", 0);
  }
  return points;
}

} // namespace epafi::deck
