#include "epafi/scene/SceneReader.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/scene/BodyReader.hpp"
#include "epafi/scene/ContactReader.hpp"
#include "epafi/scene/EquationReader.hpp"
#include "epafi/scene/GapConsistency.hpp"
#include "epafi/scene/SceneSchema.hpp"

namespace epafi::scene {
namespace {

using Teuchos::ParameterList;

/// Replaces what is default in a body's decomposition by what the scene says.
void inherit(ParameterList& body, const ParameterList& scene) {
  for (auto entry = scene.begin(); entry != scene.end(); ++entry)
    if (body.getEntry(scene.name(entry)).isDefault())
      body.setEntry(scene.name(entry), scene.entry(entry));
}

} // namespace

Scene readScene(const ParameterList& list, const std::string& where) {
  ParameterList own = list;
  own.remove("Solver", false);
  own.remove("Accuracy", false);
  ParameterList complete = validated(own, sceneSchema(), where);

  Scene scene;
  scene.title = complete.get<std::string>("Title");
  scene.holdsFreeMotions = complete.get<std::string>("Free Motions") == "hold";
  for (const std::string& name : ListReader(complete.sublist("Bodies"), where, "Bodies").names())
    inherit(complete.sublist("Bodies").sublist(name).sublist("Decomposition"),
            complete.sublist("Decomposition"));
  const ListReader bodies(complete.sublist("Bodies"), where, "Bodies");
  for (const std::string& name : bodies.names())
    scene.bodies.push_back(readBody(name, bodies.inside(name)));
  if (scene.bodies.empty())
    bodies.refuseList("has no bodies, but a scene needs at least one");
  readContacts(ListReader(complete.sublist("Contact"), where, "Contact"),
               ListReader(complete.sublist("Obstacles"), where, "Obstacles"), scene);
  readEquations(ListReader(complete.sublist("Equations"), where, "Equations"), scene);
  requireConsistentGaps(scene);
  return scene;
}

} // namespace epafi::scene
