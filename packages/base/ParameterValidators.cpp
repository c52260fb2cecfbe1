#include "epafi/base/ParameterValidators.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

namespace epafi {

using Teuchos::ParameterEntry;

void AllowedValues::printDoc(const std::string& docString, std::ostream& out) const {
  out << docString << " Allowed: " << allowed() << '\n';
}

void AllowedValues::validate(const ParameterEntry& entry, const std::string& parameter,
                             const std::string& list) const {
  if (!admits(entry))
    throw InputError("parameter \"" + parameter + "\" in list \"" + list + "\" is " + valueText(entry) +
                     ", but must be " + allowed());
}

bool Range::admits(const ParameterEntry& entry) const {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (entry.isType<int>())
    value = Teuchos::getValue<int>(entry);
  else if (entry.isType<double>())
    value = Teuchos::getValue<double>(entry);
  return std::isfinite(value) && (openBelow_ ? value > minimum_ : value >= minimum_) &&
         (openAbove_ ? value < maximum_ : value <= maximum_);
}

std::string Range::allowed() const {
  const bool hasNoMinimum = !std::isfinite(minimum_) || minimum_ == std::numeric_limits<int>::lowest();
  const bool hasNoMaximum = !std::isfinite(maximum_) || maximum_ == std::numeric_limits<int>::max();
  std::string text;
  if (!hasNoMinimum)
    text = (openBelow_ ? "> " : "≥ ") + valueText(minimum_);
  if (!hasNoMaximum)
    text += (hasNoMinimum ? "" : " and ") + std::string(openAbove_ ? "< " : "≤ ") + valueText(maximum_);
  return text;
}

bool RealOrWord::admits(const ParameterEntry& entry) const {
  return entry.isType<std::string>()
             ? std::find(words_.begin(), words_.end(), Teuchos::getValue<std::string>(entry)) != words_.end()
             : range_.admits(entry);
}

std::string RealOrWord::allowed() const {
  std::string text = range_.allowed();
  for (const std::string& word : words_)
    text += (text.empty() ? "\"" : ", or \"") + word + '"';
  return text;
}

std::optional<double> Share::parsed(const std::string& text) {
  const std::size_t last = text.find_last_not_of(' ');
  if (last == std::string::npos || text[last] != '%')
    return std::nullopt;
  try {
    return Teuchos::getValue<double>(parseValue("double", text.substr(0, last))) / 100;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool Share::admits(const ParameterEntry& entry) const {
  std::optional<double> value;
  if (entry.isType<double>())
    value = Teuchos::getValue<double>(entry);
  else if (entry.isType<std::string>())
    value = parsed(Teuchos::getValue<std::string>(entry));
  return value && *value >= 0 && *value < 1;
}

Choice::Choice(const std::vector<std::string>& words)
    : words_(Teuchos::rcp(new Teuchos::Array<std::string>(words))) {}

bool Choice::admits(const ParameterEntry& entry) const {
  return entry.isType<std::string>() &&
         std::find(words_->begin(), words_->end(), Teuchos::getValue<std::string>(entry)) != words_->end();
}

std::string Choice::allowed() const {
  std::string text = words_->size() > 1 ? "one of " : "";
  for (const std::string& word : *words_)
    text += (word == words_->front() ? "\"" : ", \"") + word + '"';
  return text;
}

} // namespace epafi
