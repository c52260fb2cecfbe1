#include "FoundPairs.hpp"

#include "DeckFiles.hpp"
#include "FacePicture.hpp"

#include "epafi/assembly/AssemblyScene.hpp"
#include "epafi/assembly/FaceWords.hpp"
#include "epafi/assembly/FacetSearch.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"
#include "epafi/meshing/GmshFile.hpp"
#include "epafi/meshing/GmshReader.hpp"
#include "epafi/meshing/MeshFiles.hpp"
#include "epafi/model/BodyLayout.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <Teuchos_DefaultSerialComm.hpp>

namespace epafi::drivers {
namespace {

using Teuchos::ParameterList;

void requireWholeSolids(const scene::Scene& scene, const std::string& file) {
  for (const scene::Body& body : scene.bodies) {
    const std::string who = file + ": pairs in contact are looked for, but body " + inQuotes(body.name);
    if (body.physics == fem::Physics::membrane)
      throw InputError(who + " is a membrane, and pairs are found of elastic bodies: give them by hand.");
    if (meshing::isSplit(body.mesh.file))
      throw InputError(who + " has a mesh in several files, which no rank sees whole: give pairs by hand.");
  }
}

FoundPairs pairsIn(const ParameterList& written, const std::string& file, bool shows) {
  ParameterList plain = written;
  if (plain.isSublist("Contact"))
    plain.sublist("Contact").remove("Automatic", false);
  const scene::Scene scene = scene::readScene(plain, file);
  requireWholeSolids(scene, file);
  const auto meshes = model::meshBodies(scene, Teuchos::SerialComm<int>());
  std::vector<std::vector<GlobalOrdinal>> numbers = nodeNumbersOf(file);
  numbers.resize(meshes.size());
  std::vector<assembly::MeshedBody> bodies;
  for (std::size_t b = 0; b < meshes.size(); ++b)
    bodies.push_back({scene.bodies[b].name, meshes[b].get(), numbers[b]});
  assembly::MeshFaces faces = assembly::meshFacesOf(bodies);
  assembly::findPairs(bodies, assembly::pairSearchIn(written, file), faces);
  FoundPairs found;
  try {
    found.contacts = pairsOf(bodies, faces, written, file, found.notes);
  } catch (const InputError& error) {
    if (!shows)
      throw;
    found.notes = error.what() + std::string(1, '\n');
  }
  found.faces = overviewOf(faces.assembly) + tableOf(faces.assembly);
  if (shows) {
    std::vector<const mesh::Mesh*> all;
    for (const assembly::MeshedBody& body : bodies)
      all.push_back(body.mesh);
    found.picture = pictureOf(faces, all);
  }
  if (found.notes.empty())
    found.notes = "no faces of two bodies are near each other, but for those of pairs given by hand\n";
  return found;
}

} // namespace

std::string pictureOfStep(const std::string& file, const assembly::Assembly& assembly) {
  const meshing::GmshFile read(meshing::readMsh(file, meshing::textOfMeshFile(file, 1, 0, 1)));
  std::vector<mesh::UnstructuredMesh> meshes;
  for (const assembly::Solid& solid : assembly.solids)
    meshes.push_back(read.body(solid.name));
  assembly::MeshFaces faces{assembly, {}};
  for (const assembly::Face& face : assembly.faces)
    faces.faces.push_back({face.solid, meshes[static_cast<std::size_t>(face.solid)].surface(face.group)});
  std::vector<const mesh::Mesh*> all;
  for (const mesh::UnstructuredMesh& mesh : meshes)
    all.push_back(&mesh);
  return pictureOf(faces, all);
}

FoundPairs findPairs(const ParameterList& written, const std::string& file, const Comm& comm, bool shows) {
  FoundPairs found; // on rank 0
  const auto onAll = [&](const auto& makeText) { return meshing::textOnAllRanks(makeText, comm); };
  const std::string contacts = onAll([&] {
    found = pairsIn(written, file, shows);
    return scene::xmlText(found.contacts);
  });
  found.contacts = scene::parseParameters(contacts, file);
  found.faces = onAll([&] { return found.faces; });
  found.notes = onAll([&] { return found.notes; });
  return found;
}

std::string takeFoundPairs(ParameterList& written, const std::string& file, const Comm& comm) {
  if (!written.isSublist("Contact") || !written.sublist("Contact").isSublist("Automatic"))
    return "";
  const FoundPairs found = findPairs(written, file, comm);
  written.sublist("Contact") = found.contacts;
  return found.notes;
}

} // namespace epafi::drivers
