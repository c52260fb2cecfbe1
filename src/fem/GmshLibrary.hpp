#pragma once

/// The Gmsh library, loaded when first used: it brings some eighty other libraries along, which a program without mesh files
/// need not wait for. Once loaded it stays. Only what GmshReader needs is here.

#include <gmshc.h>

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>

namespace epafi::fem {

/// The functions of gmshc.h that are called; each ends with an int* for its error.
struct GmshFunctions {
  decltype(&gmshInitialize) initialize = nullptr;
  decltype(&gmshFinalize) finalize = nullptr;
  decltype(&gmshFree) free = nullptr;
  decltype(&gmshOptionSetNumber) setNumber = nullptr;
  decltype(&gmshLoggerGetLastError) lastError = nullptr;
  decltype(&gmshOpen) open = nullptr;
  decltype(&gmshModelGetDimension) dimension = nullptr;
  decltype(&gmshModelGetEntities) entities = nullptr;
  decltype(&gmshModelGetPhysicalGroups) physicalGroups = nullptr;
  decltype(&gmshModelGetPhysicalName) physicalName = nullptr;
  decltype(&gmshModelGetEntitiesForPhysicalGroup) entitiesOfGroup = nullptr;
  decltype(&gmshModelMeshGenerate) generate = nullptr;
  decltype(&gmshModelMeshRefine) refine = nullptr;
  decltype(&gmshModelMeshGetNodes) nodes = nullptr;
  decltype(&gmshModelMeshGetElementTypes) elementTypes = nullptr;
  decltype(&gmshModelMeshGetElementsByType) elementsByType = nullptr;

  /// Loads the library at the first call. Throws Error if it cannot be found.
  static const GmshFunctions& get();
};

/// An array that Gmsh allocated, given back at the end.
template <class T>
class GmshArray {
public:
  GmshArray() = default;
  ~GmshArray() {
    if (data_ != nullptr)
      GmshFunctions::get().free(data_);
  }
  GmshArray(const GmshArray&) = delete;
  GmshArray& operator=(const GmshArray&) = delete;

  /// Where Gmsh is to write its address and its length.
  T** data() { return &data_; }
  std::size_t* size() { return &size_; }
  [[nodiscard]] std::span<const T> span() const { return {data_, size_}; }

private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Gmsh at work on one file, from initialisation to its end: silent, with no configuration of the user read. One at a
/// time.
class GmshSession {
public:
  explicit GmshSession(std::string file);
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  [[nodiscard]] const GmshFunctions& gmsh() const { return gmsh_; }
  [[nodiscard]] const std::string& file() const { return file_; }

  /// Calls a function and adds its last argument. Throws InputError with the file's name and Gmsh's own message.
  template <class Function, class... Arguments>
  auto call(Function function, Arguments... arguments) const {
    int error = 0;
    if constexpr (std::is_void_v<std::invoke_result_t<Function, Arguments..., int*>>) {
      function(arguments..., &error);
      if (error != 0)
        fail();
    } else {
      const auto result = function(arguments..., &error);
      if (error != 0)
        fail();
      return result;
    }
  }

private:
  [[noreturn]] void fail() const;

  const GmshFunctions& gmsh_;
  std::string file_;
};

} // namespace epafi::fem
