#pragma once

/// Validated parameter lists with error sentences that a user can act on.
///
/// A list of valid parameters (the *schema*) is an ordinary Teuchos::ParameterList with defaults,
/// documentation and validators. A sublist of the schema whose name stands in angle brackets, such as
/// `<body>`, is the pattern of any number of sublists with names of the user's choice. A parameter without a
/// sensible default is marked by setRequired().

#include <Teuchos_Array.hpp>
#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace epafi {

/// Whether a list must hold the parameters that are required, or may be a part of one that does.
enum class Completeness { whole, part };

/// Checks `given` against `schema` and returns it with every missing parameter set to its default. Entries
/// keep the order of `given`, those that were missing follow and are marked as default
/// (ParameterEntry::isDefault). What is marked so in `given`, or is an empty word or array, counts as not
/// given. Whole numbers are turned into real ones where the schema asks for these. The
/// result carries values only, no documentation or validators. Not collective.
///
/// \param where  what stands before the list's name in messages (a file, usually).
/// \throws InputError naming list, parameter, value and what is allowed: unknown name (the nearest one is
///         suggested), wrong type, value out of range, NaN or infinity, a required parameter that is not
///         given.
Teuchos::ParameterList validated(const Teuchos::ParameterList& given, const Teuchos::ParameterList& schema,
                                 const std::string& where, Completeness completeness = Completeness::whole);

/// Schema entry of a real number in [minimum, maximum]; with `openBelow` the minimum itself is not allowed,
/// with `openAbove` the maximum.
void addReal(Teuchos::ParameterList& schema, const std::string& name, double defaultValue,
             const std::string& doc, double minimum = -std::numeric_limits<double>::infinity(),
             double maximum = std::numeric_limits<double>::infinity(), bool openBelow = false,
             bool openAbove = false);

/// Schema entry of a real number in [minimum, maximum] without the minimum itself, or one of `words` in its
/// place: the value is a double or a string then.
void addRealOrWord(Teuchos::ParameterList& schema, const std::string& name, double defaultValue,
                   const std::vector<std::string>& words, const std::string& doc, double minimum,
                   double maximum);
/// Whether a schema entry is of that kind.
bool takesWords(const Teuchos::ParameterEntry& schemaEntry);

/// Schema entry of a share in [0, 1): a double, or in its place a string such as "1 %", which becomes a
/// double when the list is validated.
void addShare(Teuchos::ParameterList& schema, const std::string& name, double defaultValue,
              const std::string& doc);

/// Schema entry of a whole number in [minimum, maximum].
void addInteger(Teuchos::ParameterList& schema, const std::string& name, int defaultValue,
                const std::string& doc, int minimum = 0, int maximum = std::numeric_limits<int>::max());

/// Schema entry of one word out of `choices`. The default itself is always allowed; an empty one stands for
/// "not given".
void addChoice(Teuchos::ParameterList& schema, const std::string& name, const std::string& defaultValue,
               const std::string& doc, const std::vector<std::string>& choices);

/// The enumerator that a validated list's word stands for: that of the word's place among `choices`.
template <class Enum>
Enum enumeratorFrom(const Teuchos::ParameterList& list, const std::string& name,
                    const std::vector<std::string>& choices) {
  const auto found = std::find(choices.begin(), choices.end(), list.get<std::string>(name));
  return static_cast<Enum>(found - choices.begin());
}

/// Schema entry of an array. `allowed` says for people what its entries may be; the check is left to the
/// reader.
void addArray(Teuchos::ParameterList& schema, const std::string& name,
              const Teuchos::Array<double>& defaultValue, const std::string& doc, const std::string& allowed);
/// Likewise, of whole numbers.
void addArray(Teuchos::ParameterList& schema, const std::string& name,
              const Teuchos::Array<int>& defaultValue, const std::string& doc, const std::string& allowed);

/// Marks parameters of the schema as required: validated() refuses a list without them, and their defaults
/// mean nothing. Precondition: they are in the schema, with validators of this file if any.
void setRequired(Teuchos::ParameterList& schema, std::initializer_list<const char*> names);
/// The whole schema as a page for people, in Markdown: a title, the introduction, and a table a list with
/// type, default, range and meaning of every parameter. Ends with one newline.
std::string describeParameters(const Teuchos::ParameterList& schema, const std::string& introduction);

} // namespace epafi
