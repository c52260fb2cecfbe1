#include "epafi/base/ParameterValue.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <Teuchos_Array.hpp>

#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

namespace epafi {
namespace {

using Teuchos::Array;
using Teuchos::ParameterEntry;

std::string textOf(double value) {
  return valueText(value);
}
std::string textOf(int value) {
  return std::to_string(value);
}
std::string textOf(bool value) {
  return value ? "true" : "false";
}
std::string textOf(const std::string& value) {
  return '"' + value + '"';
}

template <class T>
std::string textOf(const Array<T>& values) {
  std::string text = "{";
  for (int i = 0; i < values.size(); ++i)
    text += (i == 0 ? "" : ", ") + textOf(values[i]);
  return text + '}';
}

std::string wholeText(const ParameterEntry& entry) {
  if (entry.isType<int>())
    return textOf(Teuchos::getValue<int>(entry));
  if (entry.isType<double>())
    return textOf(Teuchos::getValue<double>(entry));
  if (entry.isType<bool>())
    return textOf(Teuchos::getValue<bool>(entry));
  if (entry.isType<std::string>())
    return textOf(Teuchos::getValue<std::string>(entry));
  if (entry.isType<Array<int>>())
    return textOf(Teuchos::getValue<Array<int>>(entry));
  if (entry.isType<Array<double>>())
    return textOf(Teuchos::getValue<Array<double>>(entry));
  if (entry.isList() || !holdsValue(entry.getAny(false)))
    return entry.isList() ? "a list" : "empty";
  std::ostringstream text;
  text << entry.getAny(false);
  return text.str();
}

template <class T>
T parsedNumber(const std::string& text, const char* kind) {
  const std::string word = trimmed(text);
  const bool hasPlus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  const char* const begin = word.data() + (hasPlus ? 1 : 0);
  const char* const end = word.data() + word.size();
  T value{};
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument || stop != end)
    throw InputError(std::string("is not ") + kind);
  if (error == std::errc::result_out_of_range)
    throw InputError(std::string("is too large or too small for ") + kind);
  return value;
}

} // namespace

double parsedReal(const std::string& text) {
  const auto value = parsedNumber<double>(text, "a number");
  if (!std::isfinite(value))
    throw InputError("is not a finite number");
  return value;
}

namespace {

int parsedInteger(const std::string& text) {
  return parsedNumber<int>(text, "a whole number");
}

bool parsedBool(const std::string& text) {
  const std::string word = trimmed(text);
  if (word != "true" && word != "false")
    throw InputError("is neither true nor false");
  return word == "true";
}

template <class T>
Array<T> parsedArray(const std::string& text, T (*parsed)(const std::string&)) {
  const std::string word = trimmed(text);
  if (word.size() < 2 || word.front() != '{' || word.back() != '}')
    throw InputError("is not an array, such as {1, 2}");
  const std::string inside = word.substr(1, word.size() - 2);
  Array<T> values;
  if (trimmed(inside).empty())
    return values;
  for (std::size_t begin = 0; begin <= inside.size();) {
    const std::size_t end = std::min(inside.find(',', begin), inside.size());
    const std::string item = inside.substr(begin, end - begin);
    try {
      values.push_back(parsed(item));
    } catch (const InputError& error) {
      throw InputError("has entry " + std::to_string(values.size() + 1) + ", \"" + shortened(trimmed(item)) +
                       "\", which " + error.what());
    }
    begin = end + 1;
  }
  return values;
}

} // namespace

std::string spelledOut(const ParameterEntry& entry) {
  return entry.isType<std::string>() ? Teuchos::getValue<std::string>(entry) : wholeText(entry);
}

const std::vector<std::string>& parameterTypes() {
  static const std::vector<std::string> types = {"int",    "double",     "bool",
                                                 "string", "Array(int)", "Array(double)"};
  return types;
}

std::string valueText(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string typeName(const ParameterEntry& entry) {
  if (entry.isType<int>())
    return "int";
  if (entry.isType<double>())
    return "double";
  if (entry.isType<bool>())
    return "bool";
  if (entry.isType<std::string>())
    return "string";
  if (entry.isType<Array<int>>())
    return "Array(int)";
  if (entry.isType<Array<double>>())
    return "Array(double)";
  return entry.isList() ? "list" : entry.getAny(false).typeName();
}

std::string valueText(const ParameterEntry& entry) {
  return shortened(wholeText(entry));
}

ParameterEntry parseValue(const std::string& type, const std::string& text) {
  if (type == "int")
    return ParameterEntry(parsedInteger(text));
  if (type == "double")
    return ParameterEntry(parsedReal(text));
  if (type == "bool")
    return ParameterEntry(parsedBool(text));
  if (type == "Array(int)")
    return ParameterEntry(parsedArray<int>(text, parsedInteger));
  if (type == "Array(double)")
    return ParameterEntry(parsedArray<double>(text, parsedReal));
  constexpr std::size_t longest = std::size_t{1} << 20; // a list of many loads
  if (text.size() > longest)
    throw InputError("has more than " + std::to_string(longest) + " letters");
  return ParameterEntry(text);
}

} // namespace epafi
