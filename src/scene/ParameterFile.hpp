#pragma once

/// Parameter lists from XML text, read strictly: what does not parse completely is an error, never a silent
/// zero.

#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::scene {

/// Reads an input deck (.inp, .inp.gz), which becomes the list that describes the same (deck/DeckModel.hpp),
/// or a file of nested `<ParameterList>` and `<Parameter name= type= value=>` elements, in the file's order.
/// Rank 0 reads the file and broadcasts its text.
///
/// \throws InputError (the same on all ranks) if the file is missing, is a directory, is empty or larger than
///         64 MiB, and as parseParameters().
/// Collective; only rank 0's `path` counts.
Teuchos::ParameterList readParameterFile(const std::string& path, const Comm& comm);

/// The text of a list, as parseParameters() reads it. Precondition: its values are of parameterTypes().
std::string xmlText(const Teuchos::ParameterList& list);

/// The parameter list that an XML text spells out. Types are those of parameterTypes(). Lists that Teuchos
/// wrote are read too; its element `<Validators>` at the top is passed over.
///
/// \param where  the file's name, with which messages begin
/// \throws InputError if the text is no well-formed XML (with the line), holds other elements than those
/// above, lacks an attribute, names a list or parameter twice or in more than 200 bytes, nests elements more
/// than 100 deep, or a value is not completely one of its type. Not collective.
Teuchos::ParameterList parseParameters(const std::string& text, const std::string& where);

} // namespace epafi::scene
