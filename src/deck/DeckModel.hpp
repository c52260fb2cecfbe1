#pragma once

/// A deck as a scene: the parameters that a scene file would have, and the mesh that they name.

#include "epafi/deck/DeckMesh.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>
#include <vector>

namespace epafi::deck {

struct DeckModel {
  Teuchos::ParameterList scene{"Epafi"};
  MeshGroups groups; ///< of the mesh, see mshText()
  /// Of each body the deck's numbers, in the order of its mesh.
  std::vector<std::vector<GlobalOrdinal>> nodeNumbers, elementNumbers;
  /// What differs from what the deck asks for, a sentence each.
  std::vector<std::string> notes;
};

/// Bodies are what hangs together of elements of one type; where bodies share nodes, equations join them.
/// \param mesh  the name of the mesh file in the scene
/// \throws InputError "beam.inp, line 12: …" for what Epafi does not solve
DeckModel modelOf(const Deck& deck, const std::string& mesh);

/// Whether a file is a deck, by its name: .inp or .inp.gz.
bool isDeck(const std::string& file);

} // namespace epafi::deck
