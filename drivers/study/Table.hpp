#pragma once

/// What the studies measure: rows of values with names, as a CSV file and as tables to read.

#include "epafi/base/Types.hpp"

#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace epafi::drivers {

/// What was not measured: an empty field.
inline constexpr double notMeasured = std::numeric_limits<double>::quiet_NaN();

/// Values by the names of their columns: numbers, or text.
class Row {
public:
  struct Value {
    Value() = default;
    template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
    Value(Number value) // NOLINT(google-explicit-constructor): rows are lists of names and values
        : number(static_cast<double>(value)) {
      if constexpr (std::is_integral_v<Number>)
        text = std::to_string(value); // with all its digits
    }
    Value(std::string value) : text(std::move(value)) {} // NOLINT(google-explicit-constructor)
    Value(const char* value) : text(value) {}            // NOLINT(google-explicit-constructor)
    bool operator==(const Value& other) const;

    double number = notMeasured;
    std::string text = {}; ///< of a number: as it is written, if not as a double is
  };
  Row() = default;
  Row(std::initializer_list<std::pair<const std::string, Value>> values) : values_(values) {}

  Value& operator[](const std::string& column) { return values_[column]; }
  /// NaN if it is not there.
  [[nodiscard]] double number(const std::string& column) const { return value(column).number; }
  /// Empty if it is not there.
  [[nodiscard]] const std::string& text(const std::string& column) const { return value(column).text; }
  [[nodiscard]] const Value& value(const std::string& column) const;
  /// Whether these columns hold the same.
  [[nodiscard]] bool isLike(const Row& other, const std::vector<std::string>& columns) const;

private:
  std::map<std::string, Value> values_;
};

struct Table {
  /// \param names  of the columns, with commas between them. Those that end with * hold any text, in quotes
  /// \param width  digits of numbers
  explicit Table(const std::string& names, int width = 6);

  /// The first row that is like this one in some columns, or null.
  [[nodiscard]] const Row* find(const Row& like, const std::vector<std::string>& columns) const;
  [[nodiscard]] std::string header() const;
  /// Header and rows.
  [[nodiscard]] std::string csv() const;

  std::vector<Row> rows;

private:
  std::vector<std::string> columns_;
  int width_;
};

/// The rows of a CSV file without quotes: text all over; none if there is no such file.
/// \throws InputError if a row has fewer entries than `needed`, or that column is not there
std::vector<Row> readCsv(const std::filesystem::path& file, const std::vector<std::string>& needed,
                         const std::string& advice);
/// A text as a number. \throws InputError that names the file
double numberIn(const Row& row, const std::string& column, const std::filesystem::path& file,
                const std::string& advice);

/// Parts of a text, commas between them.
std::vector<std::string> splitLine(const std::string& line);

/// A line of a table in markdown; its two first ones, from names with " | " between them.
std::string markdownLine(const std::vector<std::string>& entries);
std::string markdownHeading(const std::string& names);

/// A number for people: three digits, a dash for what was not measured.
std::string inDigits(double value, int digits = 3);
/// The same as a decimal fraction, in the given unit.
std::string inUnits(double value, double unit = 1);
/// All digits of a whole number.
std::string count(double value);
/// A number as a stream writes it.
std::string plain(double value, int digits = 6);

/// Writes files into a directory and says so on rank 0. Collective.
void writeFiles(const std::filesystem::path& directory,
                const std::vector<std::pair<std::string, std::string>>& namesAndTexts, const Comm& comm);

/// Rank 0 says it, with what it has to say until now.
void tell(const Comm& comm, const std::string& text);

} // namespace epafi::drivers
