#pragma once

/// Command lines of the programs.

#include <functional>
#include <string>
#include <vector>

namespace epafi::drivers {

/// The options that a program knows, and what each does. An option's value follows it, or an = without
/// blanks. All ranks see the same arguments: nothing here is collective.
class CommandLine {
public:
  using Take = std::function<void(const std::string&)>;

  /// Knows --help, and -h. \param program  its name, for errors
  explicit CommandLine(std::string program);

  CommandLine& flag(const std::string& name, bool& isGiven);
  CommandLine& value(const std::string& name, Take take);
  CommandLine& value(const std::string& name, std::string& text);
  /// An integer in least … greatest.
  CommandLine& integer(const std::string& name, int& number, int least, int greatest);
  /// Takes the words that are no options.
  CommandLine& words(Take take);

  /// Returns whether help is asked for. \throws InputError for an unknown option, or one with a missing value
  /// or one too many
  [[nodiscard]] bool parse(int argc, const char* const* argv) const;

private:
  struct Option {
    std::string name;
    bool takesValue;
    Take take;
  };
  std::string program_;
  std::vector<Option> options_;
  Take word_;
};

/// \throws InputError if `text` is no integer or outside least … greatest
int integerOption(const std::string& option, const std::string& text, int least, int greatest);

} // namespace epafi::drivers
