#include "epafi/scene/ParameterFile.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/deck/DeckModel.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_StringInputSource.hpp>
#include <Teuchos_XMLObject.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace epafi::scene {
namespace {

using Teuchos::ParameterEntry;
using Teuchos::ParameterList;
using Teuchos::XMLObject;

std::string textOfFile(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr std::uintmax_t mostBytes = 64u << 20;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (path.empty() || !fs::exists(status))
    throw InputError("the parameter file \"" + path + "\" does not exist.");
  if (fs::is_directory(status))
    throw InputError(path + " is a directory, but must be an XML file.");
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw InputError(path + " cannot be opened for reading; check its permissions.");
  if (fs::is_regular_file(status) && fs::file_size(path, error) > mostBytes)
    throw InputError(path + " is larger than 64 MiB, which no parameter file should be.");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad())
    throw InputError(path + " could not be read to its end.");
  if (text.size() > mostBytes)
    throw InputError(path + " is larger than 64 MiB, which no parameter file should be.");
  return text;
}

std::string textOf(const std::string& path) {
  if (!deck::isDeck(path))
    return textOfFile(path);
  const std::string name = std::filesystem::path(path).filename().string();
  return xmlText(deck::modelOf(deck::readDeck(path), name).scene);
}

/// In an attribute.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text)
    result += letter == '&'   ? "&amp;"
              : letter == '<' ? "&lt;"
              : letter == '>' ? "&gt;"
              : letter == '"' ? "&quot;"
                              : std::string(1, letter);
  return result;
}

void write(const ParameterList& list, const std::string& indent, std::string& text) {
  for (auto entry = list.begin(); entry != list.end(); ++entry) {
    const std::string name = escaped(list.name(entry));
    const ParameterEntry& value = list.entry(entry);
    if (value.isList()) {
      text += indent + "<ParameterList name=\"" + name + "\">\n";
      write(Teuchos::getValue<ParameterList>(value), indent + "  ", text);
      text += indent + "</ParameterList>\n";
    } else {
      text += indent + "<Parameter name=\"" + name + "\" type=\"" + typeName(value) + "\" value=\"" +
              escaped(spelledOut(value)) + "\"/>\n";
    }
  }
}

/// Teuchos reports "… XML parse error at line 2: reason" after lines that mean nothing to a user.
[[noreturn]] void refuseMalformed(const std::string& where, const std::string& report) {
  const std::string mark = "XML parse error at line ";
  const auto found = report.rfind(mark);
  if (found == std::string::npos)
    throw InputError(where + ": this is not an XML file that can be read.");
  std::string reason = report.substr(found + mark.size());
  reason = reason.substr(0, reason.find('\n'));
  const auto colon = reason.find(": ");
  if (colon == std::string::npos)
    throw InputError(where + ": malformed XML in line " + shortened(reason) + '.');
  throw InputError(where + ", line " + reason.substr(0, colon) + ": malformed XML, " +
                   shortened(reason.substr(colon + 2)) + '.');
}

/// How deep the elements of an XML text are nested. Of a malformed one up to where it is so.
int nestingOf(const std::string& text) {
  int depth = 0, deepest = 0;
  for (std::size_t i = text.find('<'); i < text.size(); i = text.find('<', i + 1)) {
    const char next = text[std::min(i + 1, text.size() - 1)];
    if (text.compare(i, 4, "<!--") == 0) {
      i = text.find("-->", i + 4);
    } else if (next == '/') {
      --depth;
    } else if (next != '!' && next != '?') {
      char quote = '\0'; // inside which '>' is a letter
      for (++i; i < text.size() && (quote != '\0' || text[i] != '>'); ++i)
        if (quote == '\0' && (text[i] == '"' || text[i] == '\''))
          quote = text[i];
        else if (text[i] == quote)
          quote = '\0';
      if (text[i - 1] != '/')
        deepest = std::max(deepest, ++depth);
    }
    if (i == std::string::npos)
      break;
  }
  return deepest;
}

/// In UTF-8, of ASCII's as a reference, which stands for no tag.
std::string letter(unsigned long number) {
  if (number < 0x80)
    return "&#" + std::to_string(number) + ';';
  const auto tail = [&](int shift) { return static_cast<char>(0x80 | ((number >> shift) & 0x3F)); };
  if (number < 0x800)
    return {static_cast<char>(0xC0 | (number >> 6)), tail(0)};
  if (number < 0x10000)
    return {static_cast<char>(0xE0 | (number >> 12)), tail(6), tail(0)};
  return {static_cast<char>(0xF0 | (number >> 18)), tail(12), tail(6), tail(0)};
}

/// References to letters (&#228;, &#xE4;) as these letters: Teuchos knows those of bytes alone, by decimals.
std::string withLetters(const std::string& text) {
  std::string result;
  std::size_t done = 0;
  for (std::size_t i = text.find("&#"); i != std::string::npos; i = text.find("&#", i + 1)) {
    const bool isHexadecimal = text.compare(i + 2, 1, "x") == 0;
    const std::size_t begin = i + (isHexadecimal ? 3 : 2), end = text.find(';', begin);
    unsigned long number = 0;
    if (end == std::string::npos ||
        std::from_chars(&text[begin], &text[end], number, isHexadecimal ? 16 : 10).ptr != &text[end] ||
        number == 0 || number > 0x10FFFF)
      continue;
    result.append(text, done, i - done).append(letter(number));
    done = end + 1;
  }
  return result.append(text, done);
}

XMLObject parsedXml(const std::string& text, const std::string& where) {
  const std::string byteOrderMark = "\xEF\xBB\xBF";
  const bool hasMark = text.starts_with(byteOrderMark);
  const std::string content = hasMark ? text.substr(byteOrderMark.size()) : text;
  if (content.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(where + " is empty, but must hold a <ParameterList>.");
  if (content.find('\0') != std::string::npos)
    throw InputError(where + " is a binary file, but must be an XML file.");
  constexpr int deepest = 100; // the parser goes one call deeper for each
  if (nestingOf(content) > deepest)
    throw InputError(where + " nests its elements more than " + std::to_string(deepest) +
                     " deep, which no parameter file should.");
  try {
    Teuchos::StringInputSource source(withLetters(content));
    return source.getObject();
  } catch (const std::exception& error) {
    const std::string report = error.what();
    if (report.find("empty XML") != std::string::npos)
      throw InputError(where + " holds no XML element, but must hold a <ParameterList>.");
    refuseMalformed(where, report);
  }
}

/// `<name>`, for messages.
std::string tagOf(const XMLObject& element) {
  std::string tag = "<";
  return tag.append(shortened(element.getTag())).append(">");
}

/// Turns XML elements into lists; `where` and the list's path stand in the messages.
class ListBuilder {
public:
  explicit ListBuilder(std::string where) : where_(std::move(where)) {}

  void fill(ParameterList& list, const XMLObject& element, const std::string& path) const {
    checkNoText(element, path);
    for (int i = 0; i < element.numChildren(); ++i) {
      const XMLObject& child = element.getChild(i);
      if (child.getTag() == "ParameterList")
        addList(list, child, path);
      else if (child.getTag() == "Parameter")
        addParameter(list, child, path);
      else if (child.getTag() != "Validators" || !path.empty()) // Teuchos ends the lists it writes with one
        refuse(tagOf(child) + " in " + named(path) +
               " is unknown; allowed are <ParameterList> and <Parameter>.");
    }
  }

private:
  [[noreturn]] void refuse(const std::string& sentence) const {
    throw InputError(where_ + ": " + asSentence(sentence));
  }

  static std::string named(const std::string& path) {
    return path.empty() ? "the top list" : "list \"" + path + '"';
  }

  void checkNoText(const XMLObject& element, const std::string& path) const {
    for (int i = 0; i < element.numContentLines(); ++i)
      if (const std::string& line = element.getContentLine(i);
          line.find_first_not_of(" \t\r\n") != std::string::npos)
        refuse("the text \"" + shortened(line) + "\" in " + named(path) + " stands outside of any tag.");
  }

  std::string nameOf(const XMLObject& element, const ParameterList& list, const std::string& path) const {
    if (!element.hasAttribute("name"))
      refuse("a " + tagOf(element) + " in " + named(path) + " has no name; give it name=\"...\".");
    const std::string& name = element.getAttribute("name");
    constexpr std::size_t longest = 200;
    if (name.size() > longest || shortened(name) != name)
      refuse("the name \"" + shortened(name) + "\" in " + named(path) + " must have at most " +
             std::to_string(longest) + " letters and no control characters among them");
    if (list.isParameter(name))
      refuse("\"" + name + "\" appears twice in " + named(path) + "; remove or rename one of them.");
    return name;
  }

  void addList(ParameterList& list, const XMLObject& element, const std::string& path) const {
    const std::string name = nameOf(element, list, path);
    fill(list.sublist(name), element, path.empty() ? name : path + '/' + name);
  }

  void addParameter(ParameterList& list, const XMLObject& element, const std::string& path) const {
    const std::string name = nameOf(element, list, path);
    const std::string what = "parameter \"" + name + "\" in " + named(path);
    std::string types;
    for (const std::string& type : parameterTypes())
      types += (types.empty() ? "" : ", ") + type;
    for (const char* const attribute : {"type", "value"})
      if (!element.hasAttribute(attribute))
        refuse(what + " has no " + attribute + "; give it " + attribute + "=\"...\".");
    if (element.numChildren() > 0)
      refuse(what + " holds " + tagOf(element.getChild(0)) + ", but must hold nothing.");
    checkNoText(element, path.empty() ? name : path + '/' + name);
    const std::string& type = element.getAttribute("type");
    const std::string& value = element.getAttribute("value");
    if (std::ranges::find(parameterTypes(), type) == parameterTypes().end()) {
      const std::string near = nearestName(type, parameterTypes());
      refuse(what + " has the unknown type \"" + shortened(type) + "\"; allowed are " + types +
             (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
    }
    try {
      ParameterEntry entry = parseValue(type, value);
      // Lists that Teuchos has written mark the defaults among their values.
      const bool isDefault = element.hasAttribute("isDefault") && element.getAttribute("isDefault") == "true";
      entry.setAnyValue(entry.getAny(false), isDefault);
      list.setEntry(name, entry);
    } catch (const InputError& error) {
      refuse(what + " of type " + type + " has the value \"" + shortened(value) + "\", which " +
             error.what() + '.');
    }
  }

  std::string where_;
};

} // namespace

std::string xmlText(const ParameterList& list) {
  std::string text = "<ParameterList name=\"" + escaped(list.name()) + "\">\n";
  write(list, "  ", text);
  return text + "</ParameterList>\n";
}

ParameterList readParameterFile(const std::string& path, const Comm& comm) {
  std::string text, where = path;
  collectively(comm, [&] {
    if (comm.getRank() == 0)
      text = textOf(path);
  });
  for (std::string* part : {&where, &text}) {
    auto length = static_cast<int>(part->size());
    Teuchos::broadcast(comm, 0, 1, &length);
    part->resize(length);
    if (length > 0)
      Teuchos::broadcast(comm, 0, length, part->data());
  }
  ParameterList list;
  collectively(comm, [&] { list = parseParameters(text, where); });
  return list;
}

ParameterList parseParameters(const std::string& text, const std::string& where) {
  const XMLObject root = parsedXml(text, where);
  if (root.getTag() != "ParameterList")
    throw InputError(where + ": the root element is " + tagOf(root) + ", but must be <ParameterList>.");
  ParameterList list(root.hasAttribute("name") ? root.getAttribute("name") : "");
  ListBuilder(where).fill(list, root, "");
  return list;
}

} // namespace epafi::scene
