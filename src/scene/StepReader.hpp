#pragma once

/// Load steps: what of a scene changes, one step after the other.

#include "epafi/scene/Scene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace epafi::scene {

/// Whether a support holds.
enum class SupportState {
  on,   ///< at its values
  off,  ///< not
  fixed ///< where it holds, at what the step before has come to
};

/// One step. What it does not name stays as the step before had it, or the scene.
struct Step {
  using Place = std::pair<int, int>; ///< body, and the load's or support's place among its own
  std::string name;
  std::map<Place, double> loads;     ///< by what the scene's loads are multiplied
  std::map<Place, double> supports;  ///< by what the displacements that supports prescribe are multiplied
  std::map<int, double> gaps;        ///< Gap of contacts, by their places in Scene::contacts
  std::map<int, double> friction{};  ///< Friction of contacts that have it, likewise
  std::map<int, bool> isOn{};        ///< whether contacts count, likewise
  std::map<int, Preload> preloads{}; ///< of tied joints, likewise
  std::map<Place, SupportState> states{}; ///< of supports that do not merely change their values
};

/// The list `Steps` of a scene's list, in its order; none if there is none.
/// \param where  the file, for messages \param scene  as it was read from the list
/// \throws InputError if a step names what is not there. Not collective.
std::vector<Step> readSteps(const Teuchos::ParameterList& list, const std::string& where, const Scene& scene);

/// The scene as it is when steps 0 … last have been taken, but for what the solution of the step before says:
/// the lengths of locked bolts, and displacements of fixed supports.
Scene atStep(Scene scene, const std::vector<Step>& steps, std::size_t last);

} // namespace epafi::scene
