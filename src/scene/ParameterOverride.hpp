#pragma once

/// One parameter of a list, replaced from the command line.

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::scene {

/// Sets the parameter that `assignment`, "List/Sub list/Parameter=value", names, in place; what stands before
/// the first '=' is the path, what follows is the value, spelled as in the XML file. The schema gives the
/// type; the parameter, and lists that a pattern such as `<body>` allows, need not be in the list yet.
///
/// \throws InputError naming the override's text if it has no '=', names what the schema does not know or a
///         list whose name is almost that of another one, or if the value is not of the schema's type and
///         range. The list is left as it was then.
/// Not collective; the same on all ranks if called with the same arguments.
void applyOverride(Teuchos::ParameterList& list, const Teuchos::ParameterList& schema,
                   const std::string& assignment);

} // namespace epafi::scene
