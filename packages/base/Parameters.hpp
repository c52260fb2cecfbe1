#pragma once

/// Validated parameter lists with error sentences that a user can act on.
///
/// A list of valid parameters (the *schema*) is an ordinary Teuchos::ParameterList with defaults,
/// documentation and validators. A sublist of the schema whose name stands in angle brackets, such as
/// `<body>`, is the pattern of any number of sublists with names of the user's choice.

#include <Teuchos_ParameterList.hpp>

#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace epafi {

/// Checks `given` against `schema` and returns it with every missing parameter set to its default. Entries
/// keep the order of `given`, those that were missing follow and are marked as default
/// (ParameterEntry::isDefault). Whole numbers are turned into real ones where the schema asks for these. The
/// result carries values only, no documentation or validators. Not collective.
///
/// \param where  what stands before the list's name in messages (a file, usually).
/// \throws InputError naming list, parameter, value and what is allowed: unknown name (the nearest one is
/// suggested),
///         wrong type, value out of range, NaN or infinity.
Teuchos::ParameterList validated(const Teuchos::ParameterList& given, const Teuchos::ParameterList& schema,
                                 const std::string& where);

/// Schema entry of a real number in [minimum, maximum]; with `openBelow` the minimum itself is not allowed.
void addReal(Teuchos::ParameterList& schema, const std::string& name, double defaultValue,
             const std::string& doc, double minimum = -std::numeric_limits<double>::infinity(),
             double maximum = std::numeric_limits<double>::infinity(), bool openBelow = false);

/// Schema entry of a whole number in [minimum, maximum].
void addInteger(Teuchos::ParameterList& schema, const std::string& name, int defaultValue,
                const std::string& doc, int minimum = 0, int maximum = std::numeric_limits<int>::max());

/// Schema entry of one word out of `choices`. The default itself is always allowed; an empty one stands for
/// "not given".
void addChoice(Teuchos::ParameterList& schema, const std::string& name, const std::string& defaultValue,
               const std::string& doc, const std::vector<std::string>& choices);

/// The whole schema as text for people: one paragraph a parameter with type, default, range and meaning, in
/// Markdown.
std::string describeParameters(const Teuchos::ParameterList& schema);

} // namespace epafi
