#include "epafi/scene/SceneReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/SmoothPieces.hpp"
#include "epafi/scene/BodyReader.hpp"
#include "epafi/scene/ContactReader.hpp"
#include "epafi/scene/EquationReader.hpp"
#include "epafi/scene/GapConsistency.hpp"
#include "epafi/scene/SceneSchema.hpp"

#include <algorithm>

namespace epafi::scene {
namespace {

using Teuchos::ParameterList;

/// Replaces what is default in a body's decomposition by what the scene says.
void inherit(ParameterList& body, const ParameterList& scene) {
  for (auto entry = scene.begin(); entry != scene.end(); ++entry)
    if (body.getEntry(scene.name(entry)).isDefault())
      body.setEntry(scene.name(entry), scene.entry(entry));
}

/// Surfaces that are named by a place are pieces of the mesh that it has to name as it is read.
void namePieces(const std::string& where, Scene& scene) {
  const auto note = [&](Body& body, const std::string& surface) {
    if (!mesh::placeIn(surface))
      return;
    if (body.mesh.file.empty() || meshing::isSplit(body.mesh.file))
      throw InputError(where + ": the surface " + inQuotes(surface) + " of body " + inQuotes(body.name) +
                       " is a place, but only meshes of one file have surfaces so: take one of its names.");
    std::vector<std::string>& pieces = body.mesh.pieces;
    if (std::find(pieces.begin(), pieces.end(), surface) == pieces.end())
      pieces.push_back(surface);
  };
  for (Body& body : scene.bodies) {
    for (const fem::SolidSupport& support : body.supports)
      note(body, support.surface);
    for (const fem::SolidLoad& load : body.loads)
      note(body, load.where);
  }
  for (const SurfaceContact& pair : scene.contacts) {
    note(scene.bodies[pair.first], pair.firstSurface);
    if (pair.second >= 0)
      note(scene.bodies[pair.second], pair.secondSurface);
  }
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
  namePieces(where, scene);
  requireConsistentGaps(scene);
  return scene;
}

} // namespace epafi::scene
