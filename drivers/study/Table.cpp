#include "Table.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace epafi::drivers {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char letter : text)
    result.append(letter == '"' ? "\"\"" : letter == '\n' ? " " : std::string(1, letter));
  return result + "\"";
}

} // namespace

bool Row::Value::operator==(const Value& other) const {
  return number == other.number || (std::isnan(number) && std::isnan(other.number) && text == other.text);
}

const Row::Value& Row::value(const std::string& column) const {
  static const Value none;
  const auto found = values_.find(column);
  return found == values_.end() ? none : found->second;
}

bool Row::isLike(const Row& other, const std::vector<std::string>& columns) const {
  return std::all_of(columns.begin(), columns.end(),
                     [&](const std::string& column) { return value(column) == other.value(column); });
}

Table::Table(const std::string& names, int width) : columns_(splitLine(names)), width_(width) {}

const Row* Table::find(const Row& like, const std::vector<std::string>& columns) const {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.isLike(like, columns); });
  return found == rows.end() ? nullptr : &*found;
}

std::string Table::header() const {
  std::string text;
  for (const std::string& column : columns_)
    text.append(text.empty() ? "" : ",").append(column.substr(0, column.find('*')));
  return text;
}

std::string Table::csv() const {
  std::string text = header() + '\n';
  for (const Row& row : rows) {
    std::string line;
    for (const std::string& column : columns_) {
      const Row::Value& value = row.value(column.substr(0, column.find('*')));
      line += column.ends_with('*')                             ? quoted(value.text)
              : !value.text.empty() || std::isnan(value.number) ? value.text
                                                                : plain(value.number, width_);
      line += ',';
    }
    line.back() = '\n';
    text += line;
  }
  return text;
}

std::vector<Row> readCsv(const std::filesystem::path& file, const std::vector<std::string>& needed,
                         const std::string& advice) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line))
    return {};
  const std::vector<std::string> columns = splitLine(line);
  for (const std::string& column : needed)
    if (std::find(columns.begin(), columns.end(), column) == columns.end())
      throw InputError("file " + file.string() + " has no column " + column + "; " + advice);
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> entries = splitLine(line);
    if (entries.size() < needed.size())
      throw InputError("file " + file.string() + " has a row that is not complete, \"" + line + "\"; " +
                       advice);
    rows.emplace_back();
    for (std::size_t i = 0; i < std::min(entries.size(), columns.size()); ++i)
      rows.back()[columns[i]] = entries[i];
  }
  return rows;
}

double numberIn(const Row& row, const std::string& column, const std::filesystem::path& file,
                const std::string& advice) {
  try {
    return std::stod(row.text(column));
  } catch (const std::exception&) {
    throw InputError("file " + file.string() + ", column " + column + ": \"" + row.text(column) +
                     "\" is no number; " + advice);
  }
}

std::vector<std::string> splitLine(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream text(line + ',');
  for (std::string word; std::getline(text, word, ',');)
    words.push_back(word);
  return words;
}

std::string markdownLine(const std::vector<std::string>& entries) {
  std::string text = "|";
  for (const std::string& entry : entries)
    text.append(" ").append(entry).append(" |");
  return text + "\n";
}

std::string markdownHeading(const std::string& names) {
  std::string rule = "|";
  for (std::size_t at = 0; at != std::string::npos; at = names.find(" | ", at + 1))
    rule += " --- |";
  return "| " + names + " |\n" + rule + "\n";
}

std::string inDigits(double value, int digits) {
  return std::isfinite(value) ? plain(value, digits) : "–";
}

std::string inUnits(double value, double unit) {
  if (!std::isfinite(value))
    return std::isnan(value) ? "–" : "∞";
  const double scaled = value / unit;
  std::ostringstream text;
  text << std::fixed
       << std::setprecision(
              scaled == 0 ? 0
                          : std::clamp(2 - static_cast<int>(std::floor(std::log10(std::abs(scaled)))), 0, 6))
       << scaled;
  return text.str();
}

std::string count(double value) {
  return std::isnan(value) ? "–" : std::to_string(std::llround(value));
}

std::string plain(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

void writeFiles(const std::filesystem::path& directory,
                const std::vector<std::pair<std::string, std::string>>& namesAndTexts, const Comm& comm) {
  std::string names;
  for (std::size_t i = 0; i < namesAndTexts.size(); ++i) {
    const std::filesystem::path file = directory / namesAndTexts[i].first;
    output::writeTextFile(
        file, [&] { return namesAndTexts[i].second; }, comm);
    names.append(i == 0 ? "" : i + 1 < namesAndTexts.size() ? ", " : " and ").append(file.string());
  }
  tell(comm, "written: " + names);
}

void tell(const Comm& comm, const std::string& text) {
  if (comm.getRank() == 0)
    std::cout << text << std::endl;
}

} // namespace epafi::drivers
