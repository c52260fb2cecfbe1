#pragma once

/// Gmsh's functions, for the sources of this room alone: other headers do not name Gmsh.

#include "epafi/base/Errors.hpp"
#include "epafi/meshing/GmshSession.hpp"

#include <dlfcn.h>
#include <gmshc.h>

#include <string>

namespace epafi::meshing {

/// Loaded at the first call, by the name that the run-time linker knows, wherever it lies; then where CMake
/// found it. \throws Error if there is none
void* gmshLibrary();

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
  decltype(&gmshOptionGetNumber) getNumber = Symbol{library, "gmshOptionGetNumber"};
  decltype(&gmshLoggerStart) startLog = Symbol{library, "gmshLoggerStart"};
  decltype(&gmshLoggerStop) stopLog = Symbol{library, "gmshLoggerStop"};
  decltype(&gmshLoggerGet) log = Symbol{library, "gmshLoggerGet"};
  decltype(&gmshOpen) open = Symbol{library, "gmshOpen"};
  decltype(&gmshWrite) write = Symbol{library, "gmshWrite"};
  decltype(&gmshModelGetDimension) dimension = Symbol{library, "gmshModelGetDimension"};
  decltype(&gmshModelMeshGenerate) generate = Symbol{library, "gmshModelMeshGenerate"};
  decltype(&gmshModelMeshRefine) refine = Symbol{library, "gmshModelMeshRefine"};
  decltype(&gmshModelGetEntities) entities = Symbol{library, "gmshModelGetEntities"};
  decltype(&gmshModelGetType) typeOf = Symbol{library, "gmshModelGetType"};
  decltype(&gmshModelMeshRemoveConstraints) removeConstraints =
      Symbol{library, "gmshModelMeshRemoveConstraints"};
  decltype(&gmshModelMeshSetSizeCallback) setSizeCallback = Symbol{library, "gmshModelMeshSetSizeCallback"};
  decltype(&gmshModelMeshFieldSetAsBackgroundMesh) setBackground =
      Symbol{library, "gmshModelMeshFieldSetAsBackgroundMesh"};
  decltype(&gmshModelMeshClear) clear = Symbol{library, "gmshModelMeshClear"};
  decltype(&gmshModelMeshSetOrder) setOrder = Symbol{library, "gmshModelMeshSetOrder"};
  decltype(&gmshModelMeshGetElementTypes) elementTypes = Symbol{library, "gmshModelMeshGetElementTypes"};
  decltype(&gmshModelMeshGetElementsByType) elements = Symbol{library, "gmshModelMeshGetElementsByType"};
  decltype(&gmshModelGetEntityName) entityName = Symbol{library, "gmshModelGetEntityName"};
  decltype(&gmshModelGetBoundary) boundary = Symbol{library, "gmshModelGetBoundary"};
  decltype(&gmshModelGetBoundingBox) box = Symbol{library, "gmshModelGetBoundingBox"};
  decltype(&gmshModelOccGetMass) measure = Symbol{library, "gmshModelOccGetMass"};
  decltype(&gmshModelOccGetCenterOfMass) centre = Symbol{library, "gmshModelOccGetCenterOfMass"};
  decltype(&gmshModelGetParametrizationBounds) bounds = Symbol{library, "gmshModelGetParametrizationBounds"};
  decltype(&gmshModelGetParametrization) parameters = Symbol{library, "gmshModelGetParametrization"};
  decltype(&gmshModelGetClosestPoint) closest = Symbol{library, "gmshModelGetClosestPoint"};
  decltype(&gmshModelIsInside) isInside = Symbol{library, "gmshModelIsInside"};
  decltype(&gmshModelGetValue) value = Symbol{library, "gmshModelGetValue"};
  decltype(&gmshModelGetDerivative) derivative = Symbol{library, "gmshModelGetDerivative"};
  decltype(&gmshModelGetNormal) normal = Symbol{library, "gmshModelGetNormal"};
  decltype(&gmshModelGetPrincipalCurvatures) curvatures = Symbol{library, "gmshModelGetPrincipalCurvatures"};
  decltype(&gmshModelAddPhysicalGroup) addGroup = Symbol{library, "gmshModelAddPhysicalGroup"};
  decltype(&gmshModelSetPhysicalName) nameGroup = Symbol{library, "gmshModelSetPhysicalName"};
  decltype(&gmshModelMeshFieldAdd) addField = Symbol{library, "gmshModelMeshFieldAdd"};
  decltype(&gmshModelMeshFieldSetNumber) setFieldNumber = Symbol{library, "gmshModelMeshFieldSetNumber"};
  decltype(&gmshModelMeshFieldSetNumbers) setFieldNumbers = Symbol{library, "gmshModelMeshFieldSetNumbers"};
  decltype(&gmshModelMeshSetSize) setSize = Symbol{library, "gmshModelMeshSetSize"};

  static const Gmsh& get() {
    static const Gmsh functions;
    return functions;
  }
};

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

/// The first error that Gmsh has told of; empty if there is none.
std::string firstGmshError();

template <class Function, class... Arguments>
void GmshSession::call(Function function, Arguments... arguments) const {
  int error = 0;
  function(arguments..., &error);
  check(error);
}

} // namespace epafi::meshing
