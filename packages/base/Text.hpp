#pragma once

/// Numbers, points and names in sentences.

#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace epafi {

/// As a stream writes it: 0.25, 1e-09. \param digits  significant ones
std::string text(double value, int digits = 6);

/// "(1, 2, 3)", for a point or a direction.
std::string text(std::span<const double> point, int digits = 6);

/// The same of a vector of Eigen's, or whatever has data() and size().
template <class Point>
requires requires(const Point& point) {
  { point.data() } -> std::convertible_to<const double*>;
  point.size();
}
std::string text(const Point& point, int digits = 6) {
  return text(std::span<const double>(point.data(), static_cast<std::size_t>(point.size())), digits);
}

/// Without the blanks and line breaks around it.
std::string trimmed(const std::string& text);

/// "name", with the quotes.
std::string inQuotes(const std::string& text);

/// "a, b and c". \param quote  on both sides of each
std::string listed(std::span<const std::string> words, const std::string& quote = "");

/// Words, none of which has a line break, in lines of their own, and back.
template <class Words>
std::string asLines(const Words& words) {
  std::string text;
  for (const std::string& word : words)
    text += word + '\n';
  return text;
}
std::vector<std::string> linesOf(std::string_view text); ///< see asLines()

} // namespace epafi
