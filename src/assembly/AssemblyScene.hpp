#pragma once

/// A STEP file, and the few lines that complete it, as an ordinary scene.

#include "epafi/assembly/Assembly.hpp"
#include "epafi/assembly/MeshFaces.hpp"
#include "epafi/assembly/PairSearch.hpp"

#include <Teuchos_ParameterList.hpp>

#include <span>
#include <string>

namespace epafi::assembly {

/// How pairs are to be looked for. \param where  the file of `given`, for errors
PairSearch pairSearchIn(const Teuchos::ParameterList& given, const std::string& where);

struct AssemblyScene {
  Teuchos::ParameterList scene; ///< as a scene file would have it
  std::string notes;            ///< for people: what was found, and taken for what; lines
};

/// Bodies and pairs of the assembly, but for what `given` says of them; faces in words become groups of the
/// mesh.
/// \param mesh  name of the STEP file, as scenes beside it would have it
/// \param where  the file of `given`, for errors
/// \throws InputError for words that name no body, face or material. Not collective.
AssemblyScene sceneOf(const Assembly& assembly, const Teuchos::ParameterList& given, const std::string& mesh,
                      const std::string& where);

/// The list Contact of that scene. \param notes  lines for people are added
Teuchos::ParameterList pairsOf(const Assembly& assembly, const Teuchos::ParameterList& given,
                               const std::string& where, std::string& notes);

/// The list Contact of a scene whose bodies have meshes: its own pairs, and those that are found of its list
/// Automatic, but for the faces that these name. \param given  the scene  \throws InputError likewise, or if
/// facets are too coarse
Teuchos::ParameterList pairsOf(std::span<const MeshedBody> bodies, const MeshFaces& faces,
                               const Teuchos::ParameterList& given, const std::string& where,
                               std::string& notes);

/// "2 bodies with 12 faces, in mm …": a line with unit and box.
std::string overviewOf(const Assembly& assembly);

} // namespace epafi::assembly
