#include "epafi/meshing/GmshLibrary.hpp"

#include "epafi/base/Text.hpp"
#include "epafi/meshing/MshReader.hpp"

#include <string_view>
#include <type_traits>
#include <utility>

namespace epafi::meshing {

void* gmshLibrary() {
  for (const char* name : {EPAFI_GMSH_SONAME, EPAFI_GMSH_FILE})
    if (void* library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL))
      return library;
  const char* reason = ::dlerror();
  throw Error(std::string("Mesh files are read by Gmsh, whose library cannot be loaded (") +
              (reason == nullptr ? "no reason given" : reason) +
              "); install it (Debian: libgmsh-dev), or name its folder in LD_LIBRARY_PATH");
}

namespace {

/// Sizes where Gmsh asks for them.
struct ScaledSizes {
  const mesh::SizeField& field;
  double scale; ///< of what is saved, in lengths of the geometry

  [[nodiscard]] double at(double x, double y, double z) const {
    return field.at({scale * x, scale * y, scale * z}) / scale;
  }
};

/// Gmsh 4.9 and later say what they would take themselves.
template <class SetCallback>
void setSizes(SetCallback set, ScaledSizes& sizes, int* error) {
  if constexpr (std::is_invocable_v<SetCallback, double (*)(int, int, double, double, double, void*), void*,
                                    int*>)
    set([](int, int, double x, double y, double z,
           void* own) { return static_cast<const ScaledSizes*>(own)->at(x, y, z); },
        &sizes, error);
  else
    set([](int, int, double x, double y, double z, double,
           void* own) { return static_cast<const ScaledSizes*>(own)->at(x, y, z); },
        &sizes, error);
}

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

constexpr int anyEntity = -1;

} // namespace

std::string firstGmshError() {
  constexpr std::string_view kind = "Error: ";
  char** lines = nullptr;
  std::size_t number = 0;
  int error = 0;
  Gmsh::get().log(&lines, &number, &error);
  for (std::size_t i = 0; i < number; ++i) // they go with the process
    if (std::string_view(lines[i]).starts_with(kind))
      return lines[i] + kind.size();
  return "";
}

void loadGmsh() {
  (void)Gmsh::get();
}

GmshSession::GmshSession(std::string file) : file_(std::move(file)) {
  const Gmsh& gmsh = Gmsh::get();
  if (initialize(gmsh.initialize) != 0)
    throw Error("Gmsh cannot be initialised to read \"" + file_ + '"');
  constexpr int stopMeshing = 1; // to throw, as by default, ends the process: Gmsh meshes surfaces in threads
  constexpr int onlyErrors = 1;
  call(gmsh.setNumber, "General.Terminal", 0);
  call(gmsh.setNumber, "General.Verbosity", onlyErrors);
  call(gmsh.setNumber, "General.AbortOnError", stopMeshing);
  call(gmsh.startLog);
}

GmshSession::~GmshSession() {
  int error = 0;
  Gmsh::get().finalize(&error);
}

void GmshSession::check(int error) const {
  std::string text = firstGmshError();
  if (error == 0 && text.empty())
    return;
  if (text.empty())
    text = "unknown error";
  throw InputError("The mesh file " + inQuotes(file_) +
                   " cannot be read: Gmsh says: " + asSentence(shortened(text)));
}

void GmshSession::open(double meshSizeFactor, const StepSizes& sizes) const {
  call(Gmsh::get().setNumber, "Mesh.MeshSizeFactor", meshSizeFactor);
  call(Gmsh::get().open, file_.c_str());
  if (!isStep(file_))
    return;
  nameShapes();
  setStepSizes(sizes);
}

bool GmshSession::isDiscrete() const {
  GmshArray<int> entities;
  call(Gmsh::get().entities, &entities.data, &entities.size, anyEntity);
  for (std::size_t i = 0; i + 1 < entities.size; i += 2) {
    GmshArray<char> type;
    int error = 0;
    Gmsh::get().typeOf(entities.data[i], entities.data[i + 1], &type.data, &error);
    if (type.data != nullptr && std::string_view(type.data).starts_with("Discrete"))
      return true;
  }
  return false;
}

std::vector<int> GmshSession::elementTypes(int dimension) const {
  GmshArray<int> types;
  call(Gmsh::get().elementTypes, &types.data, &types.size, dimension, anyEntity);
  return {types.data, types.data + types.size};
}

void GmshSession::mesh(int refinements, int order) const {
  int error = 0;
  const int dimension = Gmsh::get().dimension(&error);
  if (dimension > 0 && elementTypes(dimension).empty())
    call(Gmsh::get().generate, dimension);
  for (int i = 0; i < refinements; ++i)
    try {
      call(Gmsh::get().refine);
    } catch (const InputError& failure) {
      throw InputError(
          failure.what() +
          std::string(" To be refined, a file of format 2.2 that lists elements once for each of their "
                      "groups must be saved in format 4.1"));
    }
  if (order == 0)
    return;
  const std::vector<int> solid = elementTypes(3);
  constexpr int hexahedra = 5;
  if (solid.size() > 1 ||
      (!solid.empty() && linearKindOfGmsh(solid.front()) > hexahedra)) // no nodes on faces
    call(Gmsh::get().setNumber, "Mesh.SecondOrderIncomplete", 1.0);
  call(Gmsh::get().setOrder, order);
}

void GmshSession::meshWith(const mesh::SizeField& sizes) const {
  GmshArray<int> entities;
  call(Gmsh::get().entities, &entities.data, &entities.size, anyEntity);
  call(Gmsh::get().removeConstraints, entities.data, entities.size);
  constexpr int none = 0;
  call(Gmsh::get().setBackground, none);
  call(Gmsh::get().clear, static_cast<int*>(nullptr), std::size_t{0}); // of what the file has meshed itself
  int error = 0;
  const int dimension = Gmsh::get().dimension(&error);
  ScaledSizes scaled{sizes, 1};
  call(Gmsh::get().getNumber, "Mesh.ScalingFactor", &scaled.scale);
  call([&](auto* failed) { setSizes(Gmsh::get().setSizeCallback, scaled, failed); });
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
    call(Gmsh::get().setNumber, name, value);
  call(Gmsh::get().generate, dimension);
  call(Gmsh::get().setOrder, 2);
}

void GmshSession::requireKnown() const {
  const std::vector<int> solid = elementTypes(3);
  for (const int type : solid.empty() ? elementTypes(2) : solid) {
    if (numNodesOfGmsh(type) > 0)
      continue;
    GmshArray<std::size_t> tags, nodes;
    constexpr std::size_t task = 0, numTasks = 1;
    call(Gmsh::get().elements, type, &tags.data, &tags.size, &nodes.data, &nodes.size, anyEntity, task,
         numTasks);
    throw InputError("The mesh file " + inQuotes(file_) + ": " + unknownKind(type, *tags.data));
  }
}

void GmshSession::save(const std::string& file) const {
  constexpr std::pair<const char*, double> options[] = {{"Mesh.MshFileVersion", 4.1},
                                                        {"Mesh.Binary", 1},
                                                        {"Mesh.SaveAll", 1},
                                                        {"Mesh.SaveParametric", 0},
                                                        {"Mesh.PartitionSplitMeshFiles", 0}};
  for (const auto& [name, value] : options)
    call(Gmsh::get().setNumber, name, value);
  call(Gmsh::get().write, file.c_str());
}

} // namespace epafi::meshing
