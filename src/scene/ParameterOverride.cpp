#include "epafi/scene/ParameterOverride.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/base/Parameters.hpp"

#include <vector>

namespace epafi::scene {
namespace {

using Teuchos::ParameterEntry;
using Teuchos::ParameterList;

std::vector<std::string> splitPath(const std::string& path) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    names.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

/// The schema's entry of that name, or of the pattern that stands for it; null if there is none.
const ParameterEntry* schemaEntry(const ParameterList& schema, const std::string& name, bool isList) {
  if (const ParameterEntry* exact = schema.getEntryPtr(name); exact != nullptr && name.front() != '<')
    return exact;
  for (auto entry = schema.begin(); isList && entry != schema.end(); ++entry)
    if (schema.name(entry).starts_with('<'))
      return &schema.entry(entry);
  return nullptr;
}

/// The schema's entry of the parameter at `path`; null if there is none.
const ParameterEntry* schemaEntry(const ParameterList& schema, const std::vector<std::string>& path) {
  const ParameterList* list = &schema;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const ParameterEntry* entry = schemaEntry(*list, path[i], true);
    if (entry == nullptr || !entry->isList())
      return nullptr;
    list = &Teuchos::getValue<ParameterList>(*entry);
  }
  const ParameterEntry* entry = schemaEntry(*list, path.back(), false);
  return entry == nullptr || entry->isList() ? nullptr : entry;
}

std::string withoutDigits(std::string name) {
  std::erase_if(name, [](char letter) { return letter >= '0' && letter <= '9'; });
  return name;
}

/// A list of the user's choice that the scene does not have is a new one, unless its name looks misspelt.
/// Names that differ in digits alone, as `load 1` and `load 2` do, are meant to differ.
/// Precondition: the schema knows the path.
void checkNewLists(const ParameterList& list, const ParameterList& schema,
                   const std::vector<std::string>& path, const std::string& where) {
  const ParameterList *inner = &list, *innerSchema = &schema;
  std::string listName;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    listName += (i == 0 ? "" : "/") + path[i];
    const ParameterEntry* found = inner->getEntryPtr(path[i]);
    if (found == nullptr && innerSchema->getEntryPtr(path[i]) == nullptr) {
      std::vector<std::string> siblings;
      for (auto entry = inner->begin(); entry != inner->end(); ++entry)
        if (withoutDigits(inner->name(entry)) != withoutDigits(path[i]))
          siblings.push_back(inner->name(entry));
      if (const std::string near = nearestName(path[i], siblings); !near.empty())
        throw InputError(where + " names the list \"" + listName +
                         "\", which the scene does not have; did you mean \"" + near + "\"?");
    }
    if (found == nullptr || !found->isList())
      return;
    inner = &Teuchos::getValue<ParameterList>(*found);
    innerSchema = &Teuchos::getValue<ParameterList>(*schemaEntry(*innerSchema, path[i], true));
  }
}

/// \throws InputError, and leaves the list as it was, if what should be a list is a parameter.
void setAt(ParameterList& list, const std::vector<std::string>& path, const ParameterEntry& value,
           const std::string& where) {
  ParameterList* inner = &list;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (inner->isParameter(path[i]) && !inner->isSublist(path[i]))
      throw InputError(where + ": \"" + path[i] + "\" is a parameter in the file, but must be a list.");
    inner = &inner->sublist(path[i]);
  }
  inner->setEntry(path.back(), value);
}

} // namespace

void applyOverride(ParameterList& list, const ParameterList& schema, const std::string& assignment) {
  const std::string where = "--set \"" + assignment + '"';
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos)
    throw InputError(where + " has no \"=\"; write \"List/Sub list/Parameter=value\".");
  const std::vector<std::string> path = splitPath(assignment.substr(0, equals));
  for (const std::string& name : path)
    if (name.empty())
      throw InputError(where +
                       " has an empty name before the \"=\"; write \"List/Sub list/Parameter=value\".");

  const ParameterEntry* valid = schemaEntry(schema, path);
  const std::string text = assignment.substr(equals + 1);
  ParameterEntry value(text);
  if (valid != nullptr) {
    const std::string type = typeName(*valid);
    try {
      value = parseValue(type, text);
    } catch (const InputError& error) {
      if (!takesWords(*valid)) // else the word itself is checked below
        throw InputError(where + ": the value \"" + text + "\" " + error.what() + ", but must be of type " +
                         type + '.');
    }
  }
  // Alone in a list, the override meets all checks, and messages speak of it rather than of the file.
  ParameterList alone;
  setAt(alone, path, value, where);
  validated(alone, schema, where, Completeness::part);
  checkNewLists(list, schema, path, where);
  setAt(list, path, value, where);
}

} // namespace epafi::scene
