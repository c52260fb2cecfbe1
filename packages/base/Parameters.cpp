#include "epafi/base/Parameters.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_ParameterEntryValidator.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace epafi {
namespace {

using Teuchos::ParameterEntry;
using Teuchos::ParameterList;

/// A validator of real numbers that does not let NaN pass and knows open intervals.
class RealInterval final : public Teuchos::ParameterEntryValidator {
public:
  RealInterval(double minimum, double maximum, bool openBelow)
      : minimum_(minimum), maximum_(maximum), openBelow_(openBelow) {}

  void validate(const ParameterEntry& entry, const std::string& name, const std::string& list) const override {
    const double value = Teuchos::getValue<double>(entry);
    const bool inside = (openBelow_ ? value > minimum_ : value >= minimum_) && value <= maximum_;
    if (!std::isfinite(value) || !inside)
      throw InputError(list + "/" + name + " is not " + describe());
  }
  void printDoc(const std::string& /*doc*/, std::ostream& out) const override { out << describe(); }
  [[nodiscard]] ValidStringsList validStringValues() const override { return Teuchos::null; }
  [[nodiscard]] const std::string getXMLTypeName() const override { return "RealInterval"; }

  [[nodiscard]] std::string describe() const {
    std::ostringstream text;
    const bool below = std::isfinite(minimum_), above = std::isfinite(maximum_);
    text << "a finite number";
    if (below)
      text << (openBelow_ ? " greater than " : " of at least ") << minimum_;
    if (above)
      text << (below ? " and at most " : " of at most ") << maximum_;
    return text.str();
  }

private:
  double minimum_, maximum_;
  bool openBelow_;
};

/// A validator of whole numbers.
class IntegerInterval final : public Teuchos::ParameterEntryValidator {
public:
  IntegerInterval(int minimum, int maximum) : minimum_(minimum), maximum_(maximum) {}

  void validate(const ParameterEntry& entry, const std::string& name, const std::string& list) const override {
    const int value = Teuchos::getValue<int>(entry);
    if (value < minimum_ || value > maximum_)
      throw InputError(list + "/" + name + " is not " + describe());
  }
  void printDoc(const std::string& /*doc*/, std::ostream& out) const override { out << describe(); }
  [[nodiscard]] ValidStringsList validStringValues() const override { return Teuchos::null; }
  [[nodiscard]] const std::string getXMLTypeName() const override { return "IntegerInterval"; }

  [[nodiscard]] std::string describe() const {
    std::string text = "a whole number of at least " + std::to_string(minimum_);
    if (maximum_ < std::numeric_limits<int>::max())
      text += " and at most " + std::to_string(maximum_);
    return text;
  }

private:
  int minimum_, maximum_;
};

/// A validator of words. (Teuchos's own header of validators is no valid C++20.)
class Choice final : public Teuchos::ParameterEntryValidator {
public:
  explicit Choice(const std::vector<std::string>& choices)
      : choices_(Teuchos::rcp(new Teuchos::Array<std::string>(choices))) {}

  void validate(const ParameterEntry& entry, const std::string& name, const std::string& list) const override {
    if (std::find(choices_->begin(), choices_->end(), Teuchos::getValue<std::string>(entry)) == choices_->end())
      throw InputError(list + "/" + name + " is none of the known words");
  }
  void printDoc(const std::string& /*doc*/, std::ostream& out) const override {
    out << "one of:";
    for (const std::string& choice : *choices_)
      out << (choice == choices_->front() ? " " : ", ") << choice;
  }
  [[nodiscard]] ValidStringsList validStringValues() const override { return choices_; }
  [[nodiscard]] const std::string getXMLTypeName() const override { return "Choice"; }

private:
  ValidStringsList choices_;
};

bool isPattern(const std::string& name) { return name.size() > 2 && name.front() == '<' && name.back() == '>'; }

/// What the schema allows for an entry, in words.
std::string allowed(const ParameterEntry& entry) {
  const auto validator = entry.validator();
  if (!validator.is_null()) {
    std::ostringstream text;
    validator->printDoc("", text);
    return text.str();
  }
  if (entry.isType<double>())
    return "a finite number";
  if (entry.isType<int>())
    return "a whole number";
  if (entry.isType<bool>())
    return "true or false";
  if (entry.isType<std::string>())
    return "a text";
  if (entry.isType<Teuchos::Array<double>>())
    return "numbers as Array(double), such as {0, 1}";
  if (entry.isType<Teuchos::Array<int>>())
    return "whole numbers as Array(int), such as {4, 4}";
  return "of type " + entry.getAny(false).typeName();
}

std::string typeName(const ParameterEntry& entry) {
  if (entry.isType<double>())
    return "double";
  if (entry.isType<int>())
    return "int";
  if (entry.isType<bool>())
    return "bool";
  if (entry.isType<std::string>())
    return "string";
  if (entry.isType<Teuchos::Array<double>>())
    return "Array(double)";
  if (entry.isType<Teuchos::Array<int>>())
    return "Array(int)";
  return entry.isList() ? "list" : entry.getAny(false).typeName();
}

std::string valueOf(const ParameterEntry& entry) {
  std::ostringstream text;
  if (entry.isList())
    return "a list";
  text << Teuchos::toString(entry.getAny(false));
  return text.str();
}

/// Path and file as they stand in messages.
class Place {
public:
  Place(std::string file, std::string path) : file_(std::move(file)), path_(std::move(path)) {}
  [[nodiscard]] Place inside(const std::string& list) const { return {file_, path_.empty() ? list : path_ + "/" + list}; }
  [[nodiscard]] std::string start() const { return file_.empty() ? "" : file_ + ": "; }
  [[nodiscard]] std::string list() const { return path_.empty() ? "the top level" : "list '" + path_ + "'"; }

private:
  std::string file_, path_;
};

[[noreturn]] void refuseUnknown(const std::string& name, bool isList, const ParameterList& schema, const Place& place) {
  std::vector<std::string> names;
  for (auto entry = schema.begin(); entry != schema.end(); ++entry)
    if (!isPattern(schema.name(entry)))
      names.push_back(schema.name(entry));
  std::string text = place.start() + "unknown " + (isList ? "list '" : "parameter '") + name + "' in " + place.list();
  const std::string near = nearestName(name, names);
  if (!near.empty()) {
    text += "; did you mean '" + near + "'?";
  } else {
    text += "; known are:";
    for (const std::string& known : names)
      text += (known == names.front() ? " '" : ", '") + known + "'";
  }
  throw InputError(text);
}

/// The entry as the schema's type (a whole number may stand for a real one), checked.
ParameterEntry converted(const std::string& name, const ParameterEntry& given, const ParameterEntry& valid,
                         const Place& place) {
  ParameterEntry entry = given;
  if (valid.isType<double>() && given.isType<int>())
    entry.setValue(static_cast<double>(Teuchos::getValue<int>(given)));
  if (valid.isType<Teuchos::Array<double>>() && given.isType<Teuchos::Array<int>>()) {
    const auto whole = Teuchos::getValue<Teuchos::Array<int>>(given);
    entry.setValue(Teuchos::Array<double>(whole.begin(), whole.end()));
  }
  const std::string what = place.start() + "parameter '" + name + "' in " + place.list();
  if (entry.isList() || entry.getAny(false).type() != valid.getAny(false).type())
    throw InputError(what + " is of type " + typeName(given) + " (value " + valueOf(given) + ") but must be " +
                     allowed(valid));
  if (entry.isType<Teuchos::Array<double>>())
    for (const double value : Teuchos::getValue<Teuchos::Array<double>>(entry))
      if (!std::isfinite(value))
        throw InputError(what + " holds a value that is not finite: " + valueOf(given));
  bool isFine = !entry.isType<double>() || std::isfinite(Teuchos::getValue<double>(entry));
  if (isFine && !valid.validator().is_null()) {
    try {
      valid.validator()->validate(entry, name, "");
    } catch (const std::exception&) {
      isFine = false;
    }
  }
  if (!isFine)
    throw InputError(what + " is " + valueOf(given) + " but must be " + allowed(valid));
  return entry;
}

void complete(ParameterList& result, const ParameterList& given, const ParameterList& schema, const Place& place);

void checkEntry(ParameterList& result, const std::string& name, const ParameterEntry& given, const ParameterList& schema,
                const Place& place) {
  std::string key = name;
  if (!schema.isParameter(name) || isPattern(name))
    for (auto entry = schema.begin(); entry != schema.end(); ++entry)
      if (isPattern(schema.name(entry)) && given.isList())
        key = schema.name(entry);
  if (!schema.isParameter(key))
    refuseUnknown(name, given.isList(), schema, place);
  const ParameterEntry& valid = schema.getEntry(key);
  if (!valid.isList()) {
    result.setEntry(name, converted(name, given, valid, place));
    return;
  }
  if (!given.isList())
    throw InputError(place.start() + "'" + name + "' in " + place.list() + " is a parameter (value " + valueOf(given) +
                     ") but must be a list");
  complete(result.sublist(name), Teuchos::getValue<ParameterList>(given), schema.sublist(key), place.inside(name));
}

void complete(ParameterList& result, const ParameterList& given, const ParameterList& schema, const Place& place) {
  for (auto entry = given.begin(); entry != given.end(); ++entry)
    checkEntry(result, given.name(entry), given.entry(entry), schema, place);
  for (auto entry = schema.begin(); entry != schema.end(); ++entry) {
    const std::string& name = schema.name(entry);
    if (isPattern(name) || result.isParameter(name))
      continue;
    if (schema.entry(entry).isList())
      complete(result.sublist(name), ParameterList(), schema.sublist(name), place.inside(name));
    else
      result.setEntry(name, schema.entry(entry));
  }
}

void describeList(std::ostream& out, const ParameterList& list, const std::string& path) {
  if (!path.empty())
    out << "\n## " << path << "\n\n";
  bool hasParameters = false;
  for (auto entry = list.begin(); entry != list.end(); ++entry) {
    const ParameterEntry& parameter = list.entry(entry);
    if (parameter.isList())
      continue;
    if (!hasParameters)
      out << "| parameter | type | default | allowed | meaning |\n| --- | --- | --- | --- | --- |\n";
    hasParameters = true;
    const std::string value = valueOf(parameter);
    out << "| `" << list.name(entry) << "` | " << typeName(parameter) << " | " << (value.empty() ? "" : "`" + value + "`")
        << " | " << allowed(parameter) << " | " << parameter.docString() << " |\n";
  }
  for (auto entry = list.begin(); entry != list.end(); ++entry)
    if (list.entry(entry).isList())
      describeList(out, list.sublist(list.name(entry)), path.empty() ? list.name(entry) : path + " / " + list.name(entry));
}

} // namespace

ParameterList validated(const ParameterList& given, const ParameterList& schema, const std::string& where) {
  ParameterList result(given.name());
  complete(result, given, schema, Place(where, ""));
  return result;
}

void addReal(ParameterList& schema, const std::string& name, double defaultValue, const std::string& doc, double minimum,
             double maximum, bool openBelow) {
  schema.set(name, defaultValue, doc, Teuchos::rcp(new RealInterval(minimum, maximum, openBelow)));
}

void addInteger(ParameterList& schema, const std::string& name, int defaultValue, const std::string& doc, int minimum,
                int maximum) {
  schema.set(name, defaultValue, doc, Teuchos::rcp(new IntegerInterval(minimum, maximum)));
}

void addChoice(ParameterList& schema, const std::string& name, const std::string& defaultValue, const std::string& doc,
               const std::vector<std::string>& choices) {
  schema.set(name, defaultValue, doc, Teuchos::rcp(new Choice(choices)));
}

std::string describeParameters(const ParameterList& schema) {
  std::ostringstream out;
  describeList(out, schema, "");
  return out.str();
}

} // namespace epafi
