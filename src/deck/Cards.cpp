#include "epafi/deck/Cards.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/deck/Fields.hpp"

#include <algorithm>
#include <utility>

namespace epafi::deck {
namespace {

constexpr std::string_view blanks = " \t\r\n\f\v";
constexpr std::size_t deepestInclude = 16, mostIncludes = 10000;

char upper(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

std::string_view unquoted(std::string_view text) {
  if (text.size() > 1 && text.front() == '"' && text.back() == '"')
    text = text.substr(1, text.size() - 2);
  return text;
}

/// Upper case, with one blank where there are some.
std::string keywordShown(std::string_view keyword) {
  std::string shown;
  for (const char letter : withoutBlanks(keyword)) {
    const bool isBlank = blanks.find(letter) != std::string_view::npos;
    if (!isBlank || shown.back() != ' ')
      shown += isBlank ? ' ' : upper(letter);
  }
  return shortened(shown);
}

} // namespace

std::string_view withoutBlanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string squeezed(std::string_view text) {
  std::string result;
  for (const char letter : unquoted(withoutBlanks(text)))
    if (blanks.find(letter) == std::string_view::npos)
      result += upper(letter);
  return result;
}

std::string text(const Place& place) {
  return shortened(place.file) + ", line " + std::to_string(place.line);
}

const Parameter* Card::find(std::string_view parameter) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const Parameter& other) { return other.name == parameter; });
  return found == parameters.end() ? nullptr : &*found;
}

std::string Card::value(std::string_view parameter) const {
  const Parameter* const found = find(parameter);
  return found == nullptr ? "" : found->value;
}

std::string Card::required(std::string_view parameter) const {
  std::string result = value(parameter);
  if (result.empty())
    refuse("it needs " + std::string(parameter) + "=");
  return result;
}

std::optional<double> Card::number(std::string_view parameter) const {
  if (!has(parameter))
    return std::nullopt;
  const std::optional<double> result = parsedReal(value(parameter));
  if (!result)
    refuse(std::string(parameter) + '=' + shortened(value(parameter)) + " should be a number");
  return result;
}

void Card::refuseAt(const Place& where, const std::string& what) const {
  throw InputError(asSentence(text(where) + ": " + shown + ": " + what));
}

Cards::Cards(const std::string& name, std::string text, Include include) : include_(std::move(include)) {
  read(name, std::move(text));
  if (cards_.empty())
    throw InputError(asSentence(deck::text({name, 1}) +
                                ": there is no keyword, such as *NODE, in the file; it is no input deck"));
}

void Cards::read(const std::string& name, std::string text) {
  texts_.push_back(std::move(text));
  names_.push_back(name);
  open_.push_back(name);
  const std::string& file = names_.back();
  std::string_view rest = texts_.back();
  std::string keywordLine; // whose end has not come yet
  Place place{file, 0};
  const auto end = [&] {
    if (!keywordLine.empty())
      add(std::exchange(keywordLine, ""), place);
  };
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t length = std::min(rest.find('\n'), rest.size());
    const std::string_view line = withoutBlanks(rest.substr(0, length));
    rest.remove_prefix(std::min(length + 1, rest.size()));
    if (line.empty() || line.starts_with("**"))
      continue;
    if (line.front() == '*') {
      end();
      place.line = number;
      keywordLine = line;
    } else if (!keywordLine.empty())
      keywordLine += line;
    else if (cards_.empty())
      textInFront_ = textInFront_.value_or(Place{file, number}); // CalculiX passes over it
    else
      cards_.back().data.push_back({line, &file, number});
    if (line.back() != ',')
      end();
  }
  end();
  open_.pop_back();
}

void Cards::add(const std::string& line, const Place& place) {
  Card card;
  card.place = place;
  std::string_view rest = line;
  for (bool isFirst = true; !rest.empty(); isFirst = false) {
    const std::size_t length = std::min(rest.find(','), rest.size());
    const std::string_view part = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    if (isFirst) {
      card.keyword = squeezed(part.substr(1));
      card.shown = '*' + keywordShown(part.substr(1));
      continue;
    }
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string_view value = part.substr(std::min(equals + 1, part.size()));
    Parameter parameter{squeezed(part.substr(0, equals)), ""};
    parameter.value =
        parameter.name == "INPUT" ? std::string(unquoted(withoutBlanks(value))) : squeezed(value);
    if (!parameter.name.empty())
      card.parameters.push_back(std::move(parameter));
  }
  if (card.keyword == "INCLUDE")
    includeFile(card);
  else
    cards_.push_back(std::move(card));
}

void Cards::includeFile(const Card& card) {
  const std::string name = card.required("INPUT");
  if (std::find(open_.begin(), open_.end(), name) != open_.end())
    card.refuse('"' + shortened(name) + "\" includes itself");
  if (open_.size() > deepestInclude || names_.size() > mostIncludes)
    card.refuse("files include each other " + std::to_string(deepestInclude) + " deep, or more than " +
                std::to_string(mostIncludes) + " times; put them into one");
  read(name, include_(name, card));
}

} // namespace epafi::deck
