#include "epafi/fem/GmshReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/fem/MshReader.hpp"
#include "epafi/scene/Body.hpp"

#include <dlfcn.h>
#include <gmshc.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <type_traits>
#include <utility>

namespace epafi::fem {
namespace {

namespace fs = std::filesystem;

/// Loaded at the first call, by the name that the run-time linker knows, wherever it lies; then where CMake found it.
void* gmshLibrary() {
  for (const char* name : {EPAFI_GMSH_SONAME, EPAFI_GMSH_FILE})
    if (void* library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL))
      return library;
  const char* reason = ::dlerror();
  throw Error(std::string("Mesh files are read by Gmsh, whose library cannot be loaded (") +
              (reason == nullptr ? "no reason given" : reason) +
              "); install it (Debian: libgmsh-dev), or name its folder in LD_LIBRARY_PATH");
}

/// A function of the library, of the type that it is assigned to.
struct Symbol {
  void* library;
  const char* name;

  template <class Function>
  operator Function*() const { // NOLINT(google-explicit-constructor): stands for the function
    auto* function = reinterpret_cast<Function*>(::dlsym(library, name));
    if (function == nullptr)
      throw Error(std::string("The library ") + EPAFI_GMSH_SONAME + " lacks the function " + name +
                  "; build Epafi anew with the Gmsh that is installed");
    return function;
  }
};

/// The functions of gmshc.h that are called; each ends with an int* for its error.
struct Gmsh {
  void* library = gmshLibrary();
  decltype(&gmshInitialize) initialize = Symbol{library, "gmshInitialize"};
  decltype(&gmshFinalize) finalize = Symbol{library, "gmshFinalize"};
  decltype(&gmshFree) free = Symbol{library, "gmshFree"};
  decltype(&gmshOptionSetNumber) setNumber = Symbol{library, "gmshOptionSetNumber"};
  decltype(&gmshLoggerGetLastError) lastError = Symbol{library, "gmshLoggerGetLastError"};
  decltype(&gmshOpen) open = Symbol{library, "gmshOpen"};
  decltype(&gmshWrite) write = Symbol{library, "gmshWrite"};
  decltype(&gmshModelGetDimension) dimension = Symbol{library, "gmshModelGetDimension"};
  decltype(&gmshModelMeshGenerate) generate = Symbol{library, "gmshModelMeshGenerate"};
  decltype(&gmshModelMeshRefine) refine = Symbol{library, "gmshModelMeshRefine"};
  decltype(&gmshModelGetEntities) entities = Symbol{library, "gmshModelGetEntities"};
  decltype(&gmshModelMeshRemoveConstraints) removeConstraints =
      Symbol{library, "gmshModelMeshRemoveConstraints"};
  decltype(&gmshModelMeshSetSizeCallback) setSizeCallback = Symbol{library, "gmshModelMeshSetSizeCallback"};
  decltype(&gmshModelMeshFieldSetAsBackgroundMesh) setBackground =
      Symbol{library, "gmshModelMeshFieldSetAsBackgroundMesh"};
  decltype(&gmshModelMeshClear) clear = Symbol{library, "gmshModelMeshClear"};
  decltype(&gmshModelMeshSetOrder) setOrder = Symbol{library, "gmshModelMeshSetOrder"};
  decltype(&gmshModelMeshGetElementTypes) elementTypes = Symbol{library, "gmshModelMeshGetElementTypes"};
  decltype(&gmshModelMeshGetElementsByType) elements = Symbol{library, "gmshModelMeshGetElementsByType"};

  static const Gmsh& get() {
    static const Gmsh functions;
    return functions;
  }
};

/// The sizes of a field where Gmsh asks for them. Gmsh 4.9 and later say what they would take themselves.
template <class SetCallback>
void setSizes(SetCallback set, const SizeField& sizes, int* error) {
  void* data = const_cast<SizeField*>(&sizes); // NOLINT: it comes back as what it is
  if constexpr (std::is_invocable_v<SetCallback, double (*)(int, int, double, double, double, void*), void*,
                                    int*>)
    set(
        [](int, int, double x, double y, double z, void* field) {
          return static_cast<const SizeField*>(field)->at({x, y, z});
        },
        data, error);
  else
    set(
        [](int, int, double x, double y, double z, double, void* field) {
          return static_cast<const SizeField*>(field)->at({x, y, z});
        },
        data, error);
}

/// An array that Gmsh allocated, given back at the end.
template <class T>
struct GmshArray {
  T* data = nullptr;
  std::size_t size = 0;

  GmshArray() = default;
  ~GmshArray() {
    if (data != nullptr)
      Gmsh::get().free(data);
  }
  GmshArray(const GmshArray&) = delete;
  GmshArray& operator=(const GmshArray&) = delete;
};

/// Gmsh 4.9 and later take one argument more: whether to run as a program.
template <class Initialize>
int initialize(Initialize function) {
  std::string name = "epafi";
  char* arguments[] = {name.data(), nullptr};
  constexpr int readConfigFiles = 0;
  int error = 0;
  if constexpr (std::is_invocable_v<Initialize, int, char**, int, int, int*>)
    function(1, arguments, readConfigFiles, 0, &error);
  else
    function(1, arguments, readConfigFiles, &error);
  return error;
}

/// Gmsh at work on one file, from initialisation to its end: silent, with no configuration of the user read. One at a
/// time.
class Session {
public:
  explicit Session(std::string file) : file_(std::move(file)) {
    if (initialize(gmsh_.initialize) != 0)
      throw Error("Gmsh cannot be initialised to read \"" + file_ + '"');
    int error = 0;
    gmsh_.setNumber("General.Terminal", 0, &error);
  }
  ~Session() {
    int error = 0;
    gmsh_.finalize(&error);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void open(double meshSizeFactor) const {
    call(gmsh_.setNumber, "Mesh.MeshSizeFactor", meshSizeFactor);
    call(gmsh_.open, file_.c_str());
  }
  /// Elements that the file does not make itself, split so many times, of an order unless it is 0.
  void mesh(int refinements, int order) const;
  /// In simplices of given sizes and order 2.
  void meshWith(const SizeField& sizes) const;
  /// Throws InputError if elements of the highest dimension are of a kind that is not known.
  void requireKnown() const;
  /// Saves all there is, whatever the file says of how and what to save.
  void save(const std::string& file) const;

private:
  [[nodiscard]] std::vector<int> elementTypes(int dimension) const;
  /// Calls a function and adds its last argument. Throws InputError with the file's name and Gmsh's own message.
  template <class Function, class... Arguments>
  void call(Function function, Arguments... arguments) const {
    int error = 0;
    function(arguments..., &error);
    if (error == 0)
      return;
    GmshArray<char> text;
    gmsh_.lastError(&text.data, &error);
    throw InputError("The mesh file " + inQuotes(file_) + " cannot be read: Gmsh says: " +
                     asSentence(text.data == nullptr || *text.data == '\0' ? "unknown error" : text.data));
  }

  static constexpr int anyEntity = -1;
  const Gmsh& gmsh_ = Gmsh::get();
  std::string file_;
};

std::vector<int> Session::elementTypes(int dimension) const {
  GmshArray<int> types;
  call(gmsh_.elementTypes, &types.data, &types.size, dimension, anyEntity);
  return {types.data, types.data + types.size};
}

void Session::mesh(int refinements, int order) const {
  int error = 0;
  const int dimension = gmsh_.dimension(&error);
  if (dimension > 0 && elementTypes(dimension).empty())
    call(gmsh_.generate, dimension);
  for (int i = 0; i < refinements; ++i)
    call(gmsh_.refine);
  if (order > 0)
    call(gmsh_.setOrder, order);
}

void Session::meshWith(const SizeField& sizes) const {
  GmshArray<int> entities;
  call(gmsh_.entities, &entities.data, &entities.size, anyEntity);
  call(gmsh_.removeConstraints, entities.data, entities.size);
  constexpr int none = 0;
  call(gmsh_.setBackground, none);
  call(gmsh_.clear, static_cast<int*>(nullptr), std::size_t{0}); // of what the file has meshed itself
  int error = 0;
  const int dimension = gmsh_.dimension(&error);
  call([&](auto* failed) { setSizes(gmsh_.setSizeCallback, sizes, failed); });
  constexpr double delaunay = 1, frontal = 6; // HXT is quicker, and another mesh each time
  for (const auto& [name, value] : {std::pair{"Mesh.MeshSizeFactor", 1.0},
                                    {"Mesh.MeshSizeMin", 0.0},
                                    {"Mesh.MeshSizeMax", 1e22},
                                    {"Mesh.MeshSizeExtendFromBoundary", 0.0},
                                    {"Mesh.MeshSizeFromPoints", 0.0},
                                    {"Mesh.MeshSizeFromCurvature", 0.0},
                                    {"Mesh.RecombineAll", 0.0},
                                    {"Mesh.SubdivisionAlgorithm", 0.0},
                                    {"General.NumThreads", 1.0}, // several give another mesh each time
                                    {"Mesh.MaxNumThreads3D", 1.0},
                                    {"Mesh.Algorithm", frontal},
                                    {"Mesh.Algorithm3D", delaunay}})
    call(gmsh_.setNumber, name, value);
  call(gmsh_.generate, dimension);
  call(gmsh_.setOrder, 2);
}

void Session::requireKnown() const {
  const std::vector<int> solid = elementTypes(3);
  for (const int type : solid.empty() ? elementTypes(2) : solid) {
    if (numNodesOfGmsh(type) > 0)
      continue;
    GmshArray<std::size_t> tags, nodes;
    constexpr std::size_t task = 0, numTasks = 1;
    call(gmsh_.elements, type, &tags.data, &tags.size, &nodes.data, &nodes.size, anyEntity, task, numTasks);
    throw InputError("The mesh file " + inQuotes(file_) + ": " +
                     unknownKind(type, static_cast<GlobalOrdinal>(*tags.data)));
  }
}

void Session::save(const std::string& file) const {
  constexpr std::pair<const char*, double> options[] = {
      {"Mesh.MshFileVersion", 4.1}, {"Mesh.Binary", 1},        {"Mesh.SaveAll", 1},
      {"Mesh.SaveParametric", 0},   {"Mesh.ScalingFactor", 1}, {"Mesh.PartitionSplitMeshFiles", 0}};
  for (const auto& [name, value] : options)
    call(gmsh_.setNumber, name, value);
  call(gmsh_.write, file.c_str());
}

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
  if (path.extension() != ".msh" && path.extension() != ".geo")
    throw InputError("The mesh file " + inQuotes(file) +
                     " is of an unknown kind; its name must end in .msh or .geo");
  if (scene::isSplit(file))
    throw InputError(
        "The mesh files " + inQuotes(file) +
        " are read by parts, but here one mesh is needed that a rank reads whole, as where it is refined "
        "or a point in it is looked for; name one file");
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
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream)
    throw InputError("The mesh file " + inQuotes(file) + " could not be read to its end");
  return text;
}

std::string textOfGmsh(const std::string& file, double meshSizeFactor, int refinements, int order) {
  const TemporaryFolder folder;
  const Session session(file);
  session.open(meshSizeFactor);
  session.mesh(refinements, order);
  session.requireKnown();
  session.save(folder.file());
  return textOf(folder.file(), file);
}

} // namespace

std::string textOfGeometry(const std::string& file, double meshSizeFactor, const SizeField& sizes) {
  checkFile(file);
  const TemporaryFolder folder;
  const Session session(file);
  session.open(meshSizeFactor);
  session.meshWith(sizes);
  session.save(folder.file());
  return textOf(folder.file(), file);
}

std::string textOfMeshFile(const std::string& file, double meshSizeFactor, int refinements, int order) {
  checkFile(file);
  if (file.ends_with(".geo"))
    return textOfGmsh(file, meshSizeFactor, refinements, order);
  std::string text = textOf(file, file);
  if (refinements == 0)
    return text;
  (void)readMsh(file, std::move(text)); // a file that is known to be sound can be handed to Gmsh
  return textOfGmsh(file, meshSizeFactor, refinements, order);
}

} // namespace epafi::fem
