#include "epafi/output/CheckpointHeader.hpp"

#include "epafi/base/Errors.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>

namespace epafi::output {
namespace {

constexpr std::string_view title = "Epafi checkpoint ";
constexpr std::string_view version = "1";
constexpr std::string_view order = std::endian::native == std::endian::little ? "little" : "big";

/// Counts in the order of the file.
constexpr std::array<std::pair<std::string_view, GlobalOrdinal Fingerprint::*>, 6> counts{
    {{"inequalities", &Fingerprint::numInequalities},
     {"equalities", &Fingerprint::numEqualities},
     {"primal", &Fingerprint::primalDimension},
     {"subdomains", &Fingerprint::numSubdomains},
     {"components", &Fingerprint::components},
     {"kernel", &Fingerprint::kernelDimension}}};

template <class Number, class... Form>
std::string textOf(Number value, Form... form) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, form...).ptr};
}

/// Line after line of a text.
class Lines {
public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// The rest of the next line, which begins with `name` and a blank.
  std::string_view valueOf(std::string_view name) {
    const std::string_view line = next();
    if (!line.starts_with(name) || line.substr(name.size()).substr(0, 1) != " ")
      refuse(name);
    return line.substr(name.size() + 1);
  }
  /// The number there, read to its end.
  template <class Number, class... Form>
  Number numberOf(std::string_view name, Form... form) {
    const std::string_view text = valueOf(name);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, form...);
    if (error != std::errc() || end != text.data() + text.size())
      refuse(name);
    return value;
  }
  std::string_view next() {
    const auto end = text_.find('\n', place_);
    if (end == std::string_view::npos)
      throw InputError("ends within its head");
    const std::string_view line = text_.substr(place_, end - place_);
    place_ = end + 1;
    return line;
  }
  [[nodiscard]] std::size_t place() const { return place_; }
  [[noreturn]] static void refuse(std::string_view name) {
    throw InputError("does not say '" + std::string(name) + "' where it should in its head");
  }

private:
  std::string_view text_;
  std::size_t place_ = 0;
};

} // namespace

std::string checkpointHeader(const Fingerprint& fingerprint) {
  std::string text(title);
  text.append(version).append("\norder ").append(order).append("\n");
  for (const auto& [name, member] : counts)
    text.append(name).append(" ").append(textOf(fingerprint.*member)).append("\n");
  return text + "rows " + textOf(fingerprint.rows, 16) + "\nstiffness " + textOf(fingerprint.stiffness) +
         "\n\n";
}

ParsedHeader parseCheckpointHeader(std::string_view text) {
  text = text.substr(0, longestCheckpointHeader);
  if (!text.starts_with(title))
    throw InputError("is no checkpoint of Epafi");
  Lines lines(text.substr(title.size()));
  if (lines.next() != version)
    throw InputError("was written by another version of Epafi");
  if (lines.valueOf("order") != order)
    throw InputError("was written on a machine that stores numbers in another order");
  ParsedHeader header;
  // So many that no sum or product of them overflows.
  constexpr GlobalOrdinal most = GlobalOrdinal{1} << 50;
  for (const auto& [name, member] : counts) {
    const auto value = lines.numberOf<GlobalOrdinal>(name);
    if (value < 0 || value > most)
      Lines::refuse(name);
    header.fingerprint.*member = value;
  }
  header.fingerprint.rows = lines.numberOf<std::uint64_t>("rows", 16);
  header.fingerprint.stiffness = lines.numberOf<double>("stiffness");
  if (!std::isfinite(header.fingerprint.stiffness))
    Lines::refuse("stiffness");
  if (!lines.next().empty())
    throw InputError("has a head that does not end");
  header.length = title.size() + lines.place();
  return header;
}

} // namespace epafi::output
