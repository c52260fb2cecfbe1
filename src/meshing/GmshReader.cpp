#include "epafi/meshing/GmshReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/deck/DeckModel.hpp"
#include "epafi/meshing/ChildProcess.hpp"
#include "epafi/meshing/GmshSession.hpp"
#include "epafi/meshing/MeshSource.hpp"
#include "epafi/meshing/MshReader.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

namespace epafi::meshing {
namespace {

namespace fs = std::filesystem;

/// A folder of our own, which is removed with all that is in it.
class TemporaryFolder {
public:
  TemporaryFolder() : path_(fs::temp_directory_path() / "epafi-XXXXXX") {
    std::string name = path_.string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error("No folder for Gmsh's mesh can be made in " + path_.parent_path().string() + ": " +
                  std::strerror(errno) + "; name another one in TMPDIR");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string file() const { return path_ / "mesh.msh"; }

private:
  fs::path path_;
};

/// What Gmsh would take for an empty model, or read without a word.
void checkFile(const std::string& file) {
  const fs::path path(file);
  if (path.extension() != ".msh" && !isGeometry(file) && !deck::isDeck(file))
    throw InputError("The mesh file " + inQuotes(file) +
                     " is of an unknown kind; its name must end in .msh, .geo, .step or .inp");
  if (isSplit(file))
    throw InputError(
        "The mesh files " + inQuotes(file) +
        " are read by parts, but here one mesh is needed that a rank reads whole, as where it is refined, "
        "a point in it is looked for, or a membrane meets an obstacle; name one file");
  if (!fs::is_regular_file(path))
    throw InputError("There is no mesh file " + inQuotes(file) + "; check its name and the folder");
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw InputError("The mesh file " + inQuotes(file) + " cannot be opened; check its permissions");
  if (path.extension() != ".geo")
    return;
  stream.seekg(-1, std::ios::end);
  if (stream.get() != '\n')
    throw InputError("The last line of the mesh file " + inQuotes(file) +
                     " has no end, so that Gmsh would pass over it; end it with a line break");
}

std::string textOf(const std::string& path, const std::string& file) {
  std::string text(fs::file_size(path), '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(text.data(), text.size());
  if (!stream)
    throw InputError("The mesh file " + inQuotes(file) + " could not be read to its end");
  return text;
}

std::string textOfDeck(const std::string& file) {
  const deck::Deck deck = deck::readDeck(file);
  return mshText(deck, modelOf(deck, file).groups);
}

} // namespace

std::string textOfGmsh(const std::string& file, double meshSizeFactor, const StepSizes& sizes,
                       const std::function<void(const GmshSession&, const std::string&)>& run) {
  checkFile(file);
  loadGmsh();
  const TemporaryFolder folder; // removed by this process, however the other one ends
  inChildProcess(
      [&] {
        const GmshSession session(file);
        session.open(meshSizeFactor, sizes);
        run(session, folder.file());
      },
      "Gmsh, at work on the mesh file " + inQuotes(file) + ',',
      "it must not say Exit, and Gmsh (gmsh " + file + ") must be able to mesh and save it by itself");
  return fs::exists(folder.file()) ? textOf(folder.file(), file) : "";
}

std::string textOfGeometry(const std::string& file, double meshSizeFactor, const mesh::SizeField& sizes) {
  return textOfGmsh(file, meshSizeFactor, {}, [&](const GmshSession& session, const std::string& saved) {
    if (session.isDiscrete())
      return;
    session.meshWith(sizes);
    session.save(saved);
  });
}

std::string textOfMeshFile(const std::string& file, double meshSizeFactor, int refinements, int order,
                           const StepSizes& sizes) {
  const auto meshed = [&] {
    return textOfGmsh(file, meshSizeFactor, sizes, [&](const GmshSession& session, const std::string& saved) {
      session.mesh(refinements, order);
      session.requireKnown();
      session.save(saved);
    });
  };
  if (isGeometry(file))
    return meshed();
  checkFile(file);
  std::string text = deck::isDeck(file) ? textOfDeck(file) : textOf(file, file);
  if (refinements == 0)
    return text;
  if (deck::isDeck(file))
    throw InputError("The mesh of the deck " + inQuotes(file) +
                     " is solved as it is; refine what epafi --export makes of it");
  (void)readMsh(file, std::move(text)); // a file that is known to be sound can be handed to Gmsh
  return meshed();
}

} // namespace epafi::meshing
