#pragma once

/// The contact pairs and rigid obstacles out of a scene's lists `Contact` and `Obstacles`.

#include "epafi/scene/ListReader.hpp"
#include "epafi/scene/Scene.hpp"

#include <optional>
#include <string>

namespace epafi::scene {

/// Fills the contacts of a scene whose bodies are there: pairs of membranes on rectangles meet along edges,
/// all others on surfaces.
/// \param list  `Contact` \param rigid  `Obstacles`
/// \throws InputError if what an obstacle's kind needs is missing or what it has no use for is given, if
/// vectors are not of one length, or a normal is 0; if a body or obstacle is unknown (the nearest name is
/// suggested), a body in contact with itself, or an obstacle in no contact; of membranes on rectangles, if an
/// edge is supported or in another pair, or the two edges do not coincide or have different numbers of
/// elements; of all others, if surfaces are not named. Whether the surfaces are in the meshes is not looked
/// at here.
void readContacts(const ListReader& list, const ListReader& rigid, Scene& scene);

/// What a bolt is tightened by: "force 100", "shortening 0.1", "locked"; nothing of another text.
std::optional<Preload> preloadOf(const std::string& text);

/// In messages: the texts that preloadOf takes.
constexpr const char* preloadForms = "force 100, shortening 0.1 or locked";

} // namespace epafi::scene
