#pragma once

/// What a scene can say beside a STEP file.

#include <Teuchos_ParameterList.hpp>

namespace epafi::assembly {

/// The list Assembly.
Teuchos::ParameterList assemblySchema();

/// The list Contact/Automatic.
Teuchos::ParameterList automaticSchema();

/// The schema of scenes with the list Contact/Automatic.
Teuchos::ParameterList withAutomatic(Teuchos::ParameterList schema);

/// The schema of scenes with what assemblies add: these two, and the materials of bodies.
Teuchos::ParameterList withAssembly(Teuchos::ParameterList schema);

} // namespace epafi::assembly
