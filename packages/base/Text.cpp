#include "epafi/base/Text.hpp"

#include <sstream>

namespace epafi {

std::string text(double value, int digits) {
  std::ostringstream result;
  result.precision(digits);
  result << value;
  return result.str();
}

std::string text(std::span<const double> point, int digits) {
  std::string result = "(";
  for (std::size_t i = 0; i < point.size(); ++i)
    result += (i > 0 ? ", " : "") + text(point[i], digits);
  return result + ')';
}

std::string trimmed(const std::string& text) {
  constexpr const char* blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string inQuotes(const std::string& text) {
  return '"' + text + '"';
}

std::string listed(std::span<const std::string> words, const std::string& quote) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i)
    list += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + quote + words[i] + quote;
  return list;
}

std::vector<std::string> linesOf(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  return lines;
}

} // namespace epafi
