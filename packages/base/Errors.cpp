#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <cctype>
#include <new>
#include <sstream>
#include <typeinfo>
#include <utility>
#include <vector>

namespace epafi {

std::size_t editDistance(const std::string& a, const std::string& b) {
  const auto lower = [](char letter) { return std::tolower(static_cast<unsigned char>(letter)); };
  const auto same = [&](std::size_t i, std::size_t j) { return lower(a[i]) == lower(b[j]); };
  // row[j]: distance of the first i letters of a from the first j of b; above and twoAbove: of one, two less
  std::vector<std::size_t> twoAbove, above, row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    twoAbove = std::move(above);
    above = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j - 1] + (same(i - 1, j - 1) ? 0 : 1), above[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && same(i - 1, j - 2) && same(i - 2, j - 1))
        row[j] = std::min(row[j], twoAbove[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string asSentence(const std::string& text) {
  return text.ends_with('?') || text.ends_with('.') ? text : text + '.';
}

std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 200;
  std::size_t end = std::min(text.size(), longest);
  const auto isInsideCharacter = [&](std::size_t place) { // of UTF-8
    return (static_cast<unsigned char>(text[place]) & 0xC0) == 0x80;
  };
  while (end < text.size() && end > 0 && isInsideCharacter(end))
    --end;
  std::string result = text.substr(0, end);
  std::replace_if(
      result.begin(), result.end(),
      [](char letter) { return std::iscntrl(static_cast<unsigned char>(letter)) != 0; }, '?');
  return end < text.size() ? result + "..." : result;
}

std::string sentenceOf(const std::exception& error, int rank) {
  const bool hasLostItsKind =
      typeid(error) == typeid(std::exception); // a library threw on a copy of the base class
  if (hasLostItsKind || dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    std::string text = hasLostItsKind ? "a library gives no reason; most likely rank " : "rank ";
    text += std::to_string(rank);
    return text + " has no memory left; spread the run over more machines, or make the mesh or the "
                  "subdomains smaller";
  }
  std::istringstream words(error.what());
  std::string text, word;
  while (words >> word)
    text += (text.empty() ? "" : " ") + word;
  return text;
}

} // namespace epafi
