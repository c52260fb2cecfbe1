#include "epafi/meshing/MshScanner.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace epafi::meshing {
namespace {

constexpr std::string_view blanks = " \t\r\n";

} // namespace

void MshScanner::refuse(const std::string& what) const {
  const auto numLines = std::count(text_.begin(), text_.begin() + last_, '\n');
  throw InputError("The mesh file \"" + name_ + "\", " +
                   (isBinary_ ? "byte " + std::to_string(last_) : "line " + std::to_string(numLines + 1)) +
                   ": " + what);
}

std::string_view MshScanner::line() {
  last_ = std::min(text_.find_first_not_of(blanks, next_), text_.size());
  const std::size_t end = std::min(text_.find('\n', last_), text_.size());
  next_ = std::min(end + 1, text_.size());
  const std::string_view line = std::string_view(text_).substr(last_, end - last_);
  return line.substr(0, line.find_last_not_of(blanks) + 1);
}

bool MshScanner::skipBehind(std::string_view text) {
  const std::size_t found = text_.find(text, next_);
  if (found == std::string::npos)
    return false;
  next_ = found + text.size();
  return true;
}

std::string_view MshScanner::word() {
  last_ = std::min(text_.find_first_not_of(blanks, next_), text_.size());
  next_ = std::min(text_.find_first_of(blanks, last_), text_.size());
  return std::string_view(text_).substr(last_, next_ - last_);
}

template <class T>
T MshScanner::fromText(std::string_view text, const char* kind) const {
  const char* const end = text.data() + text.size();
  T value{};
  const auto [stop, error] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
  if (error == std::errc::result_out_of_range && stop == end)
    refuse("the number " + shortened(std::string(text)) +
           " is too large or too small to be read; number and measure things otherwise");
  if (std::is_floating_point_v<T> && stop != end && (*stop == 'D' || *stop == 'd'))
    refuse("the exponent of \"" + shortened(std::string(text)) +
           "\" is written with Fortran's D; write it with E");
  if (error != std::errc() || stop != end)
    refuse("here should be " + std::string(kind) + ", not " +
           (text.empty() ? "the end of the file" : '"' + shortened(std::string(text)) + '"') +
           "; the file is damaged or cut off, so save it anew");
  return value;
}

template <class T>
T MshScanner::fromBytes() {
  T value{};
  last_ = next_;
  if (text_.size() - next_ < sizeof value)
    refuse("the file is cut off here; save it anew");
  std::memcpy(&value, text_.data() + next_, sizeof value);
  next_ += sizeof value;
  return value;
}

int MshScanner::integer() {
  return isBinary_ ? fromBytes<std::int32_t>() : fromText<int>(word(), "a whole number");
}

GlobalOrdinal MshScanner::tag() {
  return isBinary_ ? fromBytes<std::int32_t>() : fromText<GlobalOrdinal>(word(), "a whole number");
}

GlobalOrdinal MshScanner::whole() {
  if (!isBinary_)
    return fromText<GlobalOrdinal>(word(), "a whole number");
  const auto value = fromBytes<std::uint64_t>();
  if (std::cmp_greater(value, std::numeric_limits<GlobalOrdinal>::max()))
    refuse("the number " + std::to_string(value) + " is too large; the file is damaged, so save it anew");
  return value;
}

double MshScanner::real() {
  return isBinary_ ? fromBytes<double>() : fromText<double>(word(), "a number");
}

LocalOrdinal MshScanner::count(const std::string& things, std::size_t bytesEach, std::size_t numbersEach) {
  return checkedCount(whole(), things, bytesEach, numbersEach);
}

LocalOrdinal MshScanner::countInLine(const std::string& things, std::size_t bytesEach,
                                     std::size_t numbersEach) {
  return checkedCount(fromText<GlobalOrdinal>(line(), "a whole number"), things, bytesEach, numbersEach);
}

LocalOrdinal MshScanner::checkedCount(GlobalOrdinal number, const std::string& things, std::size_t bytesEach,
                                      std::size_t numbersEach) const {
  const std::size_t each = isBinary_ ? bytesEach : 2 * numbersEach; // a digit and a blank
  const std::size_t most = (text_.size() - next_) / each;
  if (number < 0 || std::cmp_greater(number, most))
    refuse("it promises " + std::to_string(number) + ' ' + things +
           ", but the rest of the file holds at most " + std::to_string(most) +
           "; the file is damaged or cut off, so save it anew");
  if (number > std::numeric_limits<LocalOrdinal>::max())
    refuse(std::to_string(number) + ' ' + things + " are too many; there may be " +
           std::to_string(std::numeric_limits<LocalOrdinal>::max()));
  return static_cast<LocalOrdinal>(number);
}

} // namespace epafi::meshing
