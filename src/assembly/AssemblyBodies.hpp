#pragma once

/// The bodies of an assembly's scene.

#include "epafi/assembly/Assembly.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::assembly {

/// A list of bodies, one for each solid. Found words are told of in `notes`, a line each.
/// \param given  Bodies as a scene has them, under patterns
/// \param assemblyList  the scene's list Assembly, with all that it may have
/// \throws InputError, without the name of the file
Teuchos::ParameterList bodiesOf(const Assembly& assembly, const Teuchos::ParameterList& given,
                                const Teuchos::ParameterList& assemblyList, const std::string& mesh,
                                std::string& notes);

} // namespace epafi::assembly
