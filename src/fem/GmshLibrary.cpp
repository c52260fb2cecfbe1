#include "epafi/fem/GmshLibrary.hpp"

#include "epafi/base/Errors.hpp"

#include <dlfcn.h>

#include <utility>

namespace epafi::fem {
namespace {

/// By the name that the run-time linker knows, wherever it lies; then where CMake found it.
void* loadLibrary() {
  for (const char* name : {EPAFI_GMSH_SONAME, EPAFI_GMSH_FILE})
    if (void* library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL))
      return library;
  const char* reason = ::dlerror();
  throw Error(std::string("Mesh files are read by Gmsh, whose library cannot be loaded (") +
              (reason == nullptr ? "no reason given" : reason) +
              "); install it (Debian: libgmsh-dev), or name its folder in LD_LIBRARY_PATH");
}

template <class Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  if (function == nullptr)
    throw Error(std::string("The library ") + EPAFI_GMSH_SONAME + " lacks the function " + name +
                "; build Epafi anew with the Gmsh that is installed");
}

GmshFunctions loadFunctions() {
  void* library = loadLibrary();
  GmshFunctions gmsh;
  find(library, "gmshInitialize", gmsh.initialize);
  find(library, "gmshFinalize", gmsh.finalize);
  find(library, "gmshFree", gmsh.free);
  find(library, "gmshOptionSetNumber", gmsh.setNumber);
  find(library, "gmshLoggerGetLastError", gmsh.lastError);
  find(library, "gmshOpen", gmsh.open);
  find(library, "gmshModelGetDimension", gmsh.dimension);
  find(library, "gmshModelGetEntities", gmsh.entities);
  find(library, "gmshModelGetPhysicalGroups", gmsh.physicalGroups);
  find(library, "gmshModelGetPhysicalName", gmsh.physicalName);
  find(library, "gmshModelGetEntitiesForPhysicalGroup", gmsh.entitiesOfGroup);
  find(library, "gmshModelMeshGenerate", gmsh.generate);
  find(library, "gmshModelMeshRefine", gmsh.refine);
  find(library, "gmshModelMeshGetNodes", gmsh.nodes);
  find(library, "gmshModelMeshGetElementTypes", gmsh.elementTypes);
  find(library, "gmshModelMeshGetElementsByType", gmsh.elementsByType);
  return gmsh;
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

} // namespace

const GmshFunctions& GmshFunctions::get() {
  static const GmshFunctions functions = loadFunctions();
  return functions;
}

GmshSession::GmshSession(std::string file) : gmsh_(GmshFunctions::get()), file_(std::move(file)) {
  if (initialize(gmsh_.initialize) != 0)
    throw Error("Gmsh cannot be initialised to read \"" + file_ + '"');
  int error = 0;
  gmsh_.setNumber("General.Terminal", 0, &error);
  if (error == 0)
    return;
  gmsh_.finalize(&error);
  throw Error("Gmsh cannot be silenced to read \"" + file_ + '"');
}

GmshSession::~GmshSession() {
  int error = 0;
  gmsh_.finalize(&error);
}

void GmshSession::fail() const {
  GmshArray<char> text;
  int error = 0;
  gmsh_.lastError(text.data(), &error);
  const char* said = *text.data();
  throw InputError("The mesh file \"" + file_ + "\" cannot be read: Gmsh says: " +
                   asSentence(said == nullptr || *said == '\0' ? "unknown error" : said));
}

} // namespace epafi::fem
