#pragma once

/// XML files of parameters, read so that nothing is taken for something else: every value must be what its type says, to the
/// last letter.

#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::scene {

/// Reads a Teuchos XML parameter list. One rank reads the file; all get the list. Collective.
/// \throws InputError, the same on all ranks, one sentence: missing or unreadable file, malformed XML, values that are not of
///         their type (2.5 as an int, NaN, trailing letters), names given twice.
Teuchos::ParameterList readParameterFile(const std::string& path, const Comm& comm);

/// The same from text; `where` stands for the file in messages. Not collective.
Teuchos::ParameterList parseParameters(const std::string& xml, const std::string& where);

/// Sets one parameter from "List/Sub list/Parameter=value". Its type is that of the schema, or, where the schema has a name of
/// the user's choice (<body>), of the pattern. \throws InputError that quotes the override. Not collective.
void applyOverride(Teuchos::ParameterList& list, const Teuchos::ParameterList& schema, const std::string& text);

} // namespace epafi::scene
