#include "AssemblyFiles.hpp"

#include "DeckFiles.hpp"
#include "FoundPairs.hpp"

#include "epafi/assembly/AssemblyReader.hpp"
#include "epafi/assembly/AssemblyScene.hpp"
#include "epafi/assembly/AssemblySchema.hpp"
#include "epafi/assembly/FaceWords.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/meshing/MeshSource.hpp"
#include "epafi/output/FileSet.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/ParameterOverride.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <filesystem>

namespace epafi::drivers {
namespace {

namespace fs = std::filesystem;
using Teuchos::ParameterList;

/// Lines under a word in the first columns, as the summary has them.
std::string underWord(std::string word, const std::string& lines) {
  word.resize(12, ' ');
  std::string text;
  for (const std::string& line : linesOf(lines))
    text += "  " + word + line + '\n';
  return text;
}

/// What the user has written, with the overrides.
ParameterList writtenIn(const Options& options, const Comm& comm) {
  const bool isAssembly = meshing::isStep(options.scene);
  const std::string& file = isAssembly ? options.completion : options.scene;
  ParameterList list = file.empty() ? ParameterList("Epafi") : scene::readParameterFile(file, comm);
  const ParameterList schema = isAssembly ? assembly::withAssembly(simulation::driverSchema())
                                          : assembly::withAutomatic(simulation::driverSchema());
  for (const std::string& text : options.overrides)
    scene::applyOverride(list, schema, text);
  return list;
}

const std::string& placeOf(const Options& options) {
  return options.completion.empty() ? options.scene : options.completion;
}

assembly::Assembly assemblyOf(const Options& options, const ParameterList& written, const Comm& comm) {
  return assembly::readAssembly(options.scene, assembly::pairSearchIn(written, placeOf(options)), comm);
}

} // namespace

GivenScene readGiven(const Options& options, const Comm& comm) {
  ParameterList written = writtenIn(options, comm);
  if (!meshing::isStep(options.scene)) {
    const std::string found = takeFoundPairs(written, options.scene, comm);
    return {written, notesOf(options.scene) + underWord("pairs", found)};
  }
  const assembly::AssemblyScene made = sceneOf(assemblyOf(options, written, comm), written,
                                               fs::path(options.scene).filename().string(), placeOf(options));
  return {made.scene, underWord("assembly", made.notes)};
}

std::string listOf(const Options& options, const Comm& comm) {
  const ParameterList written = writtenIn(options, comm);
  if (!meshing::isStep(options.scene)) {
    const FoundPairs found = findPairs(written, options.scene, comm, options.list);
    return options.printPairs ? scene::xmlText(found.contacts) : found.faces + found.notes;
  }
  const assembly::Assembly assembly = assemblyOf(options, written, comm);
  std::string notes;
  const ParameterList pairs = pairsOf(assembly, written, placeOf(options), notes);
  if (options.printPairs)
    return scene::xmlText(pairs);
  return overviewOf(assembly) + tableOf(assembly) + notes;
}

void showFaces(const Options& options, const RCP<const Comm>& comm) {
  if (!options.show.ends_with(".svg"))
    throw InputError("option --show writes a picture, whose name should end in .svg, not " +
                     inQuotes(options.show));
  const ParameterList written = writtenIn(options, *comm);
  std::string picture; // on rank 0
  if (meshing::isStep(options.scene)) {
    const assembly::Assembly assembly = assemblyOf(options, written, *comm);
    collectively(*comm, [&] {
      if (comm->getRank() == 0)
        picture = pictureOfStep(options.scene, assembly);
    });
  } else
    picture = findPairs(written, options.scene, *comm, true).picture;
  output::FileSet files(comm);
  files.write(options.show, [&] { return picture; });
  files.publish();
}

void exportAssembly(const Options& options, const RCP<const Comm>& comm) {
  if (!options.exported.ends_with(".xml"))
    throw InputError("option --export writes a scene, whose name should end in .xml, not " +
                     inQuotes(options.exported));
  const ParameterList written = writtenIn(options, *comm);
  const fs::path folder = fs::absolute(options.exported).parent_path();
  const assembly::AssemblyScene made =
      sceneOf(assemblyOf(options, written, *comm), written, fs::proximate(options.scene, folder).string(),
              placeOf(options));
  output::FileSet files(comm);
  files.write(options.exported, [&] { return scene::xmlText(made.scene); });
  files.publish();
}

} // namespace epafi::drivers
