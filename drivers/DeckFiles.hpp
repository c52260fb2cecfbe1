#pragma once

/// What the program does where its scene is an input deck: notes, numbers of nodes, export.

#include "epafi/deck/DeckModel.hpp"
#include "epafi/output/FrdFile.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

/// What a user should know of a deck that was read: a line each; empty of other scenes. Rank 0's is that of
/// all.
/// \throws InputError as deck::readDeck. Not collective.
std::string notesOf(const std::string& scene);

/// Of each body of a deck the deck's numbers of its nodes; of another scene none. Not collective.
std::vector<std::vector<GlobalOrdinal>> nodeNumbersOf(const std::string& scene);

/// The deck's numbers of nodes and elements; of another scene none. A node that several bodies share keeps
/// its number in the first, and gets one behind all others in the rest. Not collective.
output::FrdNumbering numberingOf(const std::string& scene);

/// Writes what was understood of a deck as a scene, and beside it its mesh, FILE.msh. Collective.
/// \throws InputError, the same on all ranks, if the scene is no deck or the file's name does not end in
/// .xml, Error if a file cannot be written
void exportDeck(const std::string& scene, const std::string& file, const RCP<const Comm>& comm);

} // namespace epafi::drivers
