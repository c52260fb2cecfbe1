#pragma once

/// The types that a parameter can have in Epafi's files, their values as text, and text as values.

#include <Teuchos_ParameterEntry.hpp>

#include <string>
#include <vector>

namespace epafi {

/// int, double, bool, string, Array(int) and Array(double): the types of parameters in XML files.
const std::vector<std::string>& parameterTypes();

/// Name of the entry's type as an XML file spells it; of a type that is none of parameterTypes(), the C++
/// name.
std::string typeName(const Teuchos::ParameterEntry& entry);

/// The value as a reader would write it: 0.1, "text", {1, 2}. Real numbers have as many digits as tell them
/// apart. Of an entry as shortened() shows it.
std::string valueText(const Teuchos::ParameterEntry& entry);
std::string valueText(double value);

/// The value as parseValue() takes it, in all its digits and letters. Precondition: of one of
/// parameterTypes().
std::string spelledOut(const Teuchos::ParameterEntry& entry);

/// The finite number that a text spells out, blanks around it aside. \throws InputError like parseValue()
double parsedReal(const std::string& text);

/// The value of a given type that a text spells out. The whole text must be the value, blanks around it
/// aside; a string has at most 2^20 bytes.
/// \param type  one of parameterTypes()
/// \throws InputError that says what is wrong with the text, to follow the words "the value … ": "is not a
///         number".
Teuchos::ParameterEntry parseValue(const std::string& type, const std::string& text);

} // namespace epafi
