#include "CommandLine.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace epafi::drivers {

CommandLine::CommandLine(std::string program) : program_(std::move(program)) {}

CommandLine& CommandLine::flag(const std::string& name, bool& isGiven) {
  options_.push_back({name, false, [&isGiven](const std::string&) { isGiven = true; }});
  return *this;
}

CommandLine& CommandLine::value(const std::string& name, Take take) {
  options_.push_back({name, true, std::move(take)});
  return *this;
}

CommandLine& CommandLine::value(const std::string& name, std::string& text) {
  return value(name, [&text](const std::string& given) { text = given; });
}

CommandLine& CommandLine::integer(const std::string& name, int& number, int least, int greatest) {
  return value(
      name, [=, &number](const std::string& text) { number = integerOption(name, text, least, greatest); });
}

CommandLine& CommandLine::words(Take take) {
  word_ = std::move(take);
  return *this;
}

bool CommandLine::parse(int argc, const char* const* argv) const {
  const std::string see = "see " + program_ + " --help";
  bool asksForHelp = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto equals = word.starts_with("--") ? word.find('=') : std::string::npos;
    std::string name = word.substr(0, equals);
    if (name == "-q")
      name = "--quiet";
    if (name.size() < 2 || name.front() != '-') {
      if (!word_)
        throw InputError("'" + word + "' is not understood; " + see);
      word_(word);
      continue;
    }
    const auto option = std::find_if(options_.begin(), options_.end(),
                                     [&](const Option& known) { return known.name == name; });
    const bool isHelp = name == "--help" || name == "-h";
    if (option == options_.end() && !isHelp) {
      std::vector<std::string> known{"--help"};
      for (const Option& other : options_)
        known.push_back(other.name);
      const std::string near = nearestName(name, known);
      throw InputError("unknown option " + name + (near.empty() ? "" : "; did you mean " + near + "?") +
                       " (" + see + ")");
    }
    asksForHelp = asksForHelp || isHelp;
    if (isHelp || !option->takesValue) {
      if (equals != std::string::npos)
        throw InputError("option " + name + " takes no value; " + see);
      if (!isHelp)
        option->take("");
      continue;
    }
    const std::string value = equals != std::string::npos ? word.substr(equals + 1)
                              : i + 1 < argc              ? argv[++i]
                                                          : "";
    if (value.empty())
      throw InputError("option " + name + " needs a value; " + see);
    option->take(value);
  }
  return asksForHelp;
}

int integerOption(const std::string& option, const std::string& text, int least, int greatest) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > greatest)
    throw InputError("option " + option + " is '" + text + "'; allowed are the integers " +
                     std::to_string(least) + " ... " + std::to_string(greatest));
  return value;
}

} // namespace epafi::drivers
