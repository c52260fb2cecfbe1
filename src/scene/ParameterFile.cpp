#include "epafi/scene/ParameterFile.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_StringInputSource.hpp>
#include <Teuchos_XMLObject.hpp>

#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

namespace epafi::scene {
namespace {

using Teuchos::ParameterList;
using Teuchos::XMLObject;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// The whole text as a number, or false.
template <class Number>
bool parse(const std::string& text, Number& value) {
  const std::string word = trimmed(text);
  const char* first = word.data();
  const char* last = first + word.size();
  if (word.size() > 1 && *first == '+')
    ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last && std::isfinite(static_cast<double>(value));
}

bool parse(const std::string& text, bool& value) {
  const std::string word = trimmed(text);
  value = word == "true" || word == "1";
  return value || word == "false" || word == "0";
}

/// "{a, b, …}" as numbers, or false.
template <class Number>
bool parse(const std::string& text, Teuchos::Array<Number>& values) {
  const std::string word = trimmed(text);
  if (word.size() < 2 || word.front() != '{' || word.back() != '}')
    return false;
  values.clear();
  std::istringstream items(word.substr(1, word.size() - 2));
  if (trimmed(items.str()).empty())
    return true;
  std::string item;
  while (std::getline(items, item, ',')) {
    Number value{};
    if (!parse(item, value))
      return false;
    values.push_back(value);
  }
  return word[word.size() - 2] != ',';
}

template <class Value>
bool setParsed(ParameterList& list, const std::string& name, const std::string& text) {
  Value value{};
  if (!parse(text, value))
    return false;
  list.set(name, value);
  return true;
}

/// Sets `name` from its text; false where the text is not of the type. \throws InputError for an unknown type.
bool setTyped(ParameterList& list, const std::string& name, const std::string& type, const std::string& text,
              const std::string& what) {
  if (type == "double" || type == "float")
    return setParsed<double>(list, name, text);
  if (type == "int")
    return setParsed<int>(list, name, text);
  if (type == "bool")
    return setParsed<bool>(list, name, text);
  if (type == "Array(double)")
    return setParsed<Teuchos::Array<double>>(list, name, text);
  if (type == "Array(int)")
    return setParsed<Teuchos::Array<int>>(list, name, text);
  if (type == "string") {
    list.set(name, text);
    return true;
  }
  throw InputError(what + " has the unknown type '" + type +
                   "'; known are: double, int, bool, string, Array(double), Array(int)");
}

void fill(ParameterList& list, const XMLObject& element, const std::string& where, const std::string& path) {
  const std::string place = path.empty() ? "the top level" : "list '" + path + "'";
  std::set<std::string> names;
  for (int i = 0; i < element.numChildren(); ++i) {
    const XMLObject child = element.getChild(i);
    const std::string tag = child.getTag();
    if (tag != "Parameter" && tag != "ParameterList")
      throw InputError(where + ": unknown element <" + tag + "> in " + place + "; known are <Parameter> and <ParameterList>");
    if (!child.hasAttribute("name"))
      throw InputError(where + ": a <" + tag + "> in " + place + " has no name");
    const std::string name = child.getAttribute("name");
    if (!names.insert(name).second)
      throw InputError(where + ": '" + name + "' stands twice in " + place + "; keep one");
    if (tag == "ParameterList") {
      fill(list.sublist(name), child, where, path.empty() ? name : path + "/" + name);
      continue;
    }
    const std::string what = where + ": parameter '" + name + "' in " + place;
    for (const char* attribute : {"type", "value"})
      if (!child.hasAttribute(attribute))
        throw InputError(what + " has no " + attribute);
    const std::string type = child.getAttribute("type"), text = child.getAttribute("value");
    if (!setTyped(list, name, type, text, what))
      throw InputError(what + " has the value '" + text + "', which is not a finite value of type " + type);
  }
}

/// The last line of a library's error text: the part that says what is wrong.
std::string lastLine(const std::string& text) {
  std::string line, last;
  for (std::istringstream lines(text); std::getline(lines, line);)
    if (!trimmed(line).empty())
      last = trimmed(line);
  return last;
}

std::string typeOf(const Teuchos::ParameterEntry& entry) {
  if (entry.isType<double>())
    return "double";
  if (entry.isType<int>())
    return "int";
  if (entry.isType<bool>())
    return "bool";
  if (entry.isType<Teuchos::Array<double>>())
    return "Array(double)";
  if (entry.isType<Teuchos::Array<int>>())
    return "Array(int)";
  return "string";
}

/// The entry of the schema under a name, or of the pattern that stands for any name.
const Teuchos::ParameterEntry* findEntry(const ParameterList& schema, const std::string& name) {
  if (schema.isParameter(name))
    return &schema.getEntry(name);
  for (auto entry = schema.begin(); entry != schema.end(); ++entry)
    if (schema.name(entry).front() == '<' && schema.entry(entry).isList())
      return &schema.entry(entry);
  return nullptr;
}

std::string suggestion(const ParameterList& schema, const std::string& name) {
  std::vector<std::string> names;
  for (auto entry = schema.begin(); entry != schema.end(); ++entry)
    names.push_back(schema.name(entry));
  const std::string near = nearestName(name, names);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

} // namespace

ParameterList parseParameters(const std::string& xml, const std::string& where) {
  if (trimmed(xml).empty())
    throw InputError(where + ": the file is empty; it must hold a <ParameterList>");
  XMLObject root;
  try {
    root = Teuchos::StringInputSource(xml).getObject();
    if (root.isEmpty())
      throw InputError("no element found");
  } catch (const std::exception& error) {
    throw InputError(where + ": malformed XML: " + lastLine(error.what()));
  }
  if (root.getTag() != "ParameterList")
    throw InputError(where + ": the outermost element is <" + root.getTag() + "> but must be <ParameterList>");
  ParameterList list(root.hasAttribute("name") ? root.getAttribute("name") : "Epafi");
  fill(list, root, where, "");
  return list;
}

ParameterList readParameterFile(const std::string& path, const Comm& comm) {
  std::string text;
  collectively(comm, [&] {
    if (comm.getRank() != 0)
      return;
    std::ifstream file(path, std::ios::binary);
    if (!file)
      throw InputError(path + ": no such file, or it may not be read");
    std::ostringstream content;
    content << file.rdbuf();
    if (!file.good() && !file.eof())
      throw InputError(path + ": it may not be read; is it a directory?");
    text = content.str();
  });
  int size = static_cast<int>(text.size());
  Teuchos::broadcast(comm, 0, 1, &size);
  text.resize(static_cast<std::size_t>(size));
  if (size > 0)
    Teuchos::broadcast(comm, 0, size, text.data());
  ParameterList list;
  collectively(comm, [&] { list = parseParameters(text, path); });
  return list;
}

void applyOverride(ParameterList& list, const ParameterList& schema, const std::string& text) {
  const std::string what = "--set \"" + text + "\"";
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(what + " is not of the form List/Sub list/Parameter=value");
  std::istringstream path(text.substr(0, equals));
  std::vector<std::string> names;
  for (std::string name; std::getline(path, name, '/');)
    names.push_back(trimmed(name));
  ParameterList* target = &list;
  const ParameterList* valid = &schema;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool isLast = i + 1 == names.size();
    const Teuchos::ParameterEntry* entry = findEntry(*valid, names[i]);
    if (entry == nullptr || entry->isList() == isLast)
      throw InputError(what + ": unknown " + (isLast ? "parameter '" : "list '") + names[i] + "'" +
                       suggestion(*valid, names[i]));
    if (isLast) {
      const std::string value = text.substr(equals + 1);
      if (!setTyped(*target, names[i], typeOf(*entry), value, what))
        throw InputError(what + ": '" + value + "' is not a finite value of type " + typeOf(*entry));
      return;
    }
    if (target->isParameter(names[i]) && !target->isSublist(names[i]))
      throw InputError(what + ": '" + names[i] + "' is a parameter, not a list");
    target = &target->sublist(names[i]);
    valid = &Teuchos::getValue<ParameterList>(*entry);
  }
}

} // namespace epafi::scene
