#include "epafi/base/Parameters.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValidators.hpp"
#include "epafi/base/ParameterValue.hpp"

#include <cmath>
#include <sstream>

namespace epafi {
namespace {

using Teuchos::Array;
using Teuchos::ParameterEntry;
using Teuchos::ParameterList;

bool isPattern(const std::string& name) {
  return name.size() > 2 && name.front() == '<' && name.back() == '>';
}

std::vector<std::string> namesOf(const ParameterList& list) {
  std::vector<std::string> names;
  for (auto entry = list.begin(); entry != list.end(); ++entry)
    names.push_back(list.name(entry));
  return names;
}

std::string patternOf(const ParameterList& schema) {
  for (const std::string& name : namesOf(schema))
    if (isPattern(name))
      return name;
  return {};
}

/// Where a message points to: the file and the path of the list.
struct Place {
  std::string file, path;

  [[nodiscard]] std::string list() const { return path.empty() ? "the top list" : "list \"" + path + '"'; }
  [[nodiscard]] Place inside(const std::string& name) const {
    return {file, path.empty() ? name : path + '/' + name};
  }
  [[noreturn]] void refuse(const std::string& sentence) const {
    throw InputError((file.empty() ? "" : file + ": ") + asSentence(sentence));
  }
  [[noreturn]] void refuse(const std::string& parameter, const ParameterEntry& found,
                           const std::string& mustBe) const {
    refuse("parameter \"" + parameter + "\" in " + list() + " is " + valueText(found) + ", but must be " +
           mustBe);
  }
};

[[noreturn]] void refuseUnknown(const std::string& name, const ParameterEntry& entry,
                                const ParameterList& schema, const Place& place) {
  std::vector<std::string> known = namesOf(schema);
  std::erase_if(known, isPattern);
  std::string sentence = entry.isList() ? "list \"" + name + "\" in " + place.list() + " is unknown; "
                                        : "parameter \"" + name + "\" in " + place.list() + ", with value " +
                                              valueText(entry) + ", is unknown; ";
  const std::string near = nearestName(name, known);
  if (!near.empty())
    place.refuse(sentence + "did you mean \"" + near + "\"?");
  if (const std::string pattern = patternOf(schema); !pattern.empty())
    place.refuse(sentence + "only lists, one for each " + pattern + ", are allowed here");
  sentence += known.empty() ? "nothing is allowed here" : "allowed are ";
  for (std::size_t i = 0; i < known.size(); ++i)
    sentence += (i == 0 ? "\"" : ", \"") + known[i] + '"';
  place.refuse(sentence);
}

/// The bare value, without documentation and validator, so that the result can be written to a file.
ParameterEntry bare(const ParameterEntry& entry, bool isDefault) {
  ParameterEntry copy;
  copy.setAnyValue(entry.getAny(false), isDefault);
  return copy;
}

/// The value as the schema's type: whole numbers may stand for real ones.
ParameterEntry converted(const ParameterEntry& given, const ParameterEntry& valid) {
  if (valid.isType<double>() && given.isType<int>())
    return ParameterEntry(static_cast<double>(Teuchos::getValue<int>(given)), given.isDefault());
  if (valid.isType<Array<double>>() && given.isType<Array<int>>()) {
    const auto& whole = Teuchos::getValue<Array<int>>(given);
    return ParameterEntry(Array<double>(whole.begin(), whole.end()), given.isDefault());
  }
  if (const AllowedValues* allowed = allowedValues(valid);
      allowed != nullptr && allowed->isShare && given.isType<std::string>() && allowed->admits(given))
    return ParameterEntry(*shareFrom(Teuchos::getValue<std::string>(given)), given.isDefault());
  return bare(given, given.isDefault());
}

bool isFinite(const ParameterEntry& entry) {
  if (entry.isType<double>())
    return std::isfinite(Teuchos::getValue<double>(entry));
  if (entry.isType<Array<double>>())
    for (const double value : Teuchos::getValue<Array<double>>(entry))
      if (!std::isfinite(value))
        return false;
  return true;
}

std::string allowedText(const ParameterEntry& schemaEntry) {
  const AllowedValues* allowed = allowedValues(schemaEntry);
  return allowed != nullptr ? allowed->text : "";
}

bool isRequired(const ParameterEntry& schemaEntry) {
  const AllowedValues* allowed = allowedValues(schemaEntry);
  return allowed != nullptr && allowed->isRequired;
}

/// The schema's own default is always allowed, also where it stands for "not given" (an empty word).
void checkRange(const std::string& name, const ParameterEntry& entry, const ParameterEntry& valid,
                const Place& place) {
  if (valid.validator().is_null() || entry.getAny(false).same(valid.getAny(false)))
    return;
  try {
    valid.validator()->validate(entry, name, place.path);
  } catch (const std::exception&) {
    std::string mustBe = allowedText(valid);
    if (mustBe.empty())
      mustBe = "a value that its validator, " + valid.validator()->getXMLTypeName() + ", accepts";
    if (entry.isType<std::string>() && !valid.validator()->validStringValues().is_null()) {
      const std::string near =
          nearestName(Teuchos::getValue<std::string>(entry), *valid.validator()->validStringValues());
      mustBe += near.empty() ? "" : "; did you mean \"" + near + "\"?";
    }
    place.refuse(name, entry, mustBe);
  }
}

ParameterEntry checkedParameter(const std::string& name, const ParameterEntry& given,
                                const ParameterEntry& valid, const Place& place) {
  if (given.isList())
    place.refuse("\"" + name + "\" in " + place.list() + " is a list, but must be a parameter of type " +
                 typeName(valid));
  ParameterEntry entry = converted(given, valid);
  const bool isWord = takesWords(valid) && entry.isType<std::string>();
  if (typeName(entry) != typeName(valid) && !isWord)
    place.refuse("parameter \"" + name + "\" in " + place.list() + " is " + valueText(given) + " of type " +
                 typeName(given) + ", but must be of type " + typeName(valid));
  if (!isFinite(entry)) {
    const std::string allowed = allowedText(valid);
    place.refuse(name, entry,
                 entry.isType<double>() ? "a finite number" + (allowed.empty() ? "" : ' ' + allowed)
                                        : "an array of finite numbers");
  }
  checkRange(name, entry, valid, place);
  return entry;
}

/// An empty word or array stands for "not given".
bool isGiven(const ParameterList& list, const std::string& name) {
  const ParameterEntry* entry = list.getEntryPtr(name);
  return entry != nullptr && !entry->isDefault() && valueText(*entry) != "\"\"" && valueText(*entry) != "{}";
}

ParameterList checkedList(const ParameterList& given, const ParameterList& schema, const Place& place,
                          Completeness completeness);

void addChecked(ParameterList& result, const std::string& name, const ParameterEntry& entry,
                const ParameterList& schema, const Place& place, Completeness completeness) {
  const ParameterEntry* valid = isPattern(name) ? nullptr : schema.getEntryPtr(name);
  const std::string pattern = patternOf(schema);
  if (valid == nullptr && entry.isList() && !pattern.empty()) {
    if (name.empty() || name == "." || name.find('/') != std::string::npos)
      place.refuse("list \"" + name + "\" in " + place.list() + " needs another name: the name of a " +
                   pattern + " must not be empty, not be \".\" and not contain \"/\"");
    valid = schema.getEntryPtr(pattern);
  }
  if (valid == nullptr)
    refuseUnknown(name, entry, schema, place);
  if (!valid->isList())
    result.setEntry(name, checkedParameter(name, entry, *valid, place));
  else if (entry.isList())
    result.sublist(name).setParameters(checkedList(Teuchos::getValue<ParameterList>(entry),
                                                   Teuchos::getValue<ParameterList>(*valid),
                                                   place.inside(name), completeness));
  else
    place.refuse("\"" + name + "\" in " + place.list() + " is a parameter with value " + valueText(entry) +
                 ", but must be a list");
}

ParameterList checkedList(const ParameterList& given, const ParameterList& schema, const Place& place,
                          Completeness completeness) {
  ParameterList result(given.name());
  for (const std::string& name : namesOf(given))
    addChecked(result, name, given.getEntry(name), schema, place, completeness);
  for (const std::string& name : namesOf(schema)) {
    const ParameterEntry& valid = schema.getEntry(name);
    if (completeness == Completeness::whole && isRequired(valid) && !isGiven(given, name))
      place.refuse(place.list() + " lacks its parameter \"" + name + "\" of type " + typeName(valid) +
                   ", which must be given");
    if (isPattern(name) || given.isParameter(name))
      continue;
    if (valid.isList())
      result.sublist(name).setParameters(checkedList(ParameterList(), Teuchos::getValue<ParameterList>(valid),
                                                     place.inside(name), completeness));
    else
      result.setEntry(name, bare(valid, true));
  }
  return result;
}

void describeList(std::ostream& out, const ParameterList& schema, const std::string& path,
                  const std::string& doc) {
  if (!path.empty())
    out << "\n## `" << path << "`\n"; // in backticks: <body> is no HTML
  if (!doc.empty())
    out << '\n' << doc << '\n';
  bool hasParameters = false;
  for (const std::string& name : namesOf(schema)) {
    const ParameterEntry& entry = schema.getEntry(name);
    if (entry.isList())
      continue;
    if (!hasParameters)
      out << "\n| Parameter | Type | Default | Allowed | Meaning |\n| --- | --- | --- | --- | --- |\n";
    hasParameters = true;
    out << "| " << name << " | " << typeName(entry) << (takesWords(entry) ? " or string" : "") << " | "
        << (isRequired(entry) ? "required" : '`' + valueText(entry) + '`') << " | " << allowedText(entry)
        << " | " << entry.docString() << " |\n";
  }
  for (const std::string& name : namesOf(schema))
    if (const ParameterEntry& entry = schema.getEntry(name); entry.isList())
      describeList(out, Teuchos::getValue<ParameterList>(entry), path.empty() ? name : path + '/' + name,
                   entry.docString());
}

} // namespace

ParameterList validated(const ParameterList& given, const ParameterList& schema, const std::string& where,
                        Completeness completeness) {
  return checkedList(given, schema, {where, ""}, completeness);
}

std::string describeParameters(const ParameterList& schema, const std::string& introduction) {
  std::ostringstream out;
  out << "# Parameters\n\n" << introduction << '\n';
  describeList(out, schema, "", "");
  return out.str();
}

} // namespace epafi
