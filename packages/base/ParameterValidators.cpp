#include "epafi/base/ParameterValidators.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

namespace epafi {

using Teuchos::Array;
using Teuchos::ParameterEntry;
using Teuchos::ParameterList;

namespace {

/// Unlike ParameterList::set, this lets an empty default pass the validator.
template <class Value>
void add(ParameterList& schema, const std::string& name, const Value& defaultValue, const std::string& doc,
         const AllowedValues& allowed) {
  schema.setEntry(name,
                  ParameterEntry(defaultValue, false, false, doc, Teuchos::rcp(new AllowedValues(allowed))));
}

/// Says what is allowed, and leaves the check to who reads the parameter.
AllowedValues remark(const std::string& text) {
  AllowedValues allowed;
  allowed.text = text;
  return allowed;
}

/// An int or double between minimum and maximum; an end that is open is not allowed itself. Never NaN or
/// infinite.
AllowedValues range(double minimum, double maximum, bool openBelow, bool openAbove) {
  const bool hasNoMinimum = !std::isfinite(minimum) || minimum == std::numeric_limits<int>::lowest();
  const bool hasNoMaximum = !std::isfinite(maximum) || maximum == std::numeric_limits<int>::max();
  std::string text;
  if (!hasNoMinimum)
    text = (openBelow ? "> " : "≥ ") + valueText(minimum);
  if (!hasNoMaximum)
    text += (hasNoMinimum ? "" : " and ") + std::string(openAbove ? "< " : "≤ ") + valueText(maximum);
  AllowedValues allowed = remark(text);
  allowed.admits = [=](const ParameterEntry& entry) {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (entry.isType<int>())
      value = Teuchos::getValue<int>(entry);
    else if (entry.isType<double>())
      value = Teuchos::getValue<double>(entry);
    return std::isfinite(value) && (openBelow ? value > minimum : value >= minimum) &&
           (openAbove ? value < maximum : value <= maximum);
  };
  return allowed;
}

bool isAmong(const std::vector<std::string>& words, const ParameterEntry& entry) {
  return entry.isType<std::string>() &&
         std::find(words.begin(), words.end(), Teuchos::getValue<std::string>(entry)) != words.end();
}

} // namespace

void AllowedValues::printDoc(const std::string& docString, std::ostream& out) const {
  out << docString << " Allowed: " << text << '\n';
}

void AllowedValues::validate(const ParameterEntry& entry, const std::string& parameter,
                             const std::string& list) const {
  if (admits && !admits(entry))
    throw InputError("parameter \"" + parameter + "\" in list \"" + list + "\" is " + valueText(entry) +
                     ", but must be " + text);
}

void addReal(ParameterList& schema, const std::string& name, double defaultValue, const std::string& doc,
             double minimum, double maximum, bool openBelow, bool openAbove) {
  add(schema, name, defaultValue, doc, range(minimum, maximum, openBelow, openAbove));
}

void addInteger(ParameterList& schema, const std::string& name, int defaultValue, const std::string& doc,
                int minimum, int maximum) {
  add(schema, name, defaultValue, doc, range(minimum, maximum, false, false));
}

void addRealOrWord(ParameterList& schema, const std::string& name, double defaultValue,
                   const std::vector<std::string>& words, const std::string& doc, double minimum,
                   double maximum) {
  AllowedValues allowed = range(minimum, maximum, true, false);
  allowed.takesWords = true;
  allowed.admits = [isInRange = allowed.admits, words](const ParameterEntry& entry) {
    return isAmong(words, entry) || isInRange(entry);
  };
  for (const std::string& word : words)
    allowed.text += (allowed.text.empty() ? "" : ", or ") + inQuotes(word);
  add(schema, name, defaultValue, doc, allowed);
}

bool takesWords(const ParameterEntry& schemaEntry) {
  const AllowedValues* allowed = allowedValues(schemaEntry);
  return allowed != nullptr && allowed->takesWords;
}

std::optional<double> shareFrom(const std::string& text) {
  const std::size_t last = text.find_last_not_of(' ');
  if (last == std::string::npos || text[last] != '%')
    return std::nullopt;
  try {
    return Teuchos::getValue<double>(parseValue("double", text.substr(0, last))) / 100;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void addShare(ParameterList& schema, const std::string& name, double defaultValue, const std::string& doc) {
  AllowedValues allowed = remark("≥ 0 and < 1, or per cents such as \"1 %\"");
  allowed.takesWords = allowed.isShare = true;
  allowed.admits = [](const ParameterEntry& entry) {
    std::optional<double> value;
    if (entry.isType<double>())
      value = Teuchos::getValue<double>(entry);
    else if (entry.isType<std::string>())
      value = shareFrom(Teuchos::getValue<std::string>(entry));
    return value && *value >= 0 && *value < 1;
  };
  add(schema, name, defaultValue, doc, allowed);
}

void addChoice(ParameterList& schema, const std::string& name, const std::string& defaultValue,
               const std::string& doc, const std::vector<std::string>& choices) {
  AllowedValues allowed = remark(choices.size() > 1 ? "one of " : "");
  for (const std::string& word : choices)
    allowed.text += (word == choices.front() ? "" : ", ") + inQuotes(word);
  allowed.words = Teuchos::rcp(new Array<std::string>(choices));
  allowed.admits = [choices](const ParameterEntry& entry) { return isAmong(choices, entry); };
  add(schema, name, defaultValue, doc, allowed);
}

void addArray(ParameterList& schema, const std::string& name, const Array<double>& defaultValue,
              const std::string& doc, const std::string& allowed) {
  add(schema, name, defaultValue, doc, remark(allowed));
}

void addArray(ParameterList& schema, const std::string& name, const Array<int>& defaultValue,
              const std::string& doc, const std::string& allowed) {
  add(schema, name, defaultValue, doc, remark(allowed));
}

void setRequired(ParameterList& schema, std::initializer_list<const char*> names) {
  for (const char* const name : names) {
    ParameterEntry& entry = schema.getEntry(name);
    const AllowedValues* known = allowedValues(entry);
    AllowedValues allowed = known != nullptr ? *known : AllowedValues();
    allowed.isRequired = true;
    entry.setValidator(Teuchos::rcp(new AllowedValues(allowed)));
  }
}

} // namespace epafi
