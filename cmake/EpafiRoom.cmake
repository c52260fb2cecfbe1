# A room of the house is one library: its folder holds headers and sources side by side, and its headers are included as
# "epafi/<room>/<Name>.hpp" through a link in the build tree, so that a file has one address everywhere, installed too.

set(EPAFI_INCLUDE_ROOT "${PROJECT_BINARY_DIR}/include")
file(MAKE_DIRECTORY "${EPAFI_INCLUDE_ROOT}/epafi")

# Warnings for our own code.
function(epafi_warnings target)
  # Programs are compiled as libraries are, so that they share precompiled headers.
  # GCC looks for garbage that it could free again and again; with a gigabyte to fill first it compiles in less time, and takes a fifth more memory.
  target_compile_options(${target} PRIVATE -fPIC
    "$<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess;SHELL:--param ggc-min-heapsize=1000000;SHELL:--param ggc-min-expand=100>"
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(EPAFI_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# The same, and sanitizers, with assertions.
function(epafi_flags target)
  epafi_warnings(${target})
  if(EPAFI_SANITIZE)
    # GCC 12 takes sanitized code of Eigen for uninitialized. Null pointers and what lies outside of objects are what the
    # address sanitizer sees; without these checks, and that of alignment, code compiles in two thirds of the time.
    # Eigen allocates otherwise when sanitized, unless it is told not to; tests free what libraries allocate.
    target_compile_options(${target} PRIVATE -O1 -g1 -UNDEBUG -fsanitize=${EPAFI_SANITIZE} -fno-omit-frame-pointer
                                             -DEIGEN_MALLOC_ALREADY_ALIGNED=1
                                             -fno-sanitize=null,alignment,object-size
                                             -fno-sanitize-recover=undefined -D_GLIBCXX_ASSERTIONS
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_link_options(${target} PRIVATE -fsanitize=${EPAFI_SANITIZE})
  endif()
endfunction()

# epafi_own_code(<target>): the flags of our own code, and what nearly every unit of it includes, read once for all of them.
# Units include all that they use themselves: clang-tidy reads them without what is precompiled.
function(epafi_own_code target)
  epafi_flags(${target})
  get_target_property(standard ${target} CXX_STANDARD)
  if(NOT standard EQUAL 17)
    target_precompile_headers(${target} REUSE_FROM epafi_precompiled)
  endif()
endfunction()

# epafi_precompiled_headers(<target> FLAGS epafi_flags HEADERS <a.hpp> ... USES Epafi::eigen ...): what epafi_own_code takes, with the flags of its users.
function(epafi_precompiled_headers target)
  cmake_parse_arguments(PARSE_ARGV 1 PRECOMPILED "" "FLAGS" "HEADERS;USES")
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/${target}.cpp" CONTENT "")
  add_library(${target} OBJECT "${PROJECT_BINARY_DIR}/${target}.cpp")
  target_link_libraries(${target} PRIVATE ${PRECOMPILED_USES})
  target_precompile_headers(${target} PRIVATE ${PRECOMPILED_HEADERS})
  cmake_language(CALL ${PRECOMPILED_FLAGS} ${target})
endfunction()

epafi_precompiled_headers(epafi_precompiled FLAGS epafi_flags
  HEADERS <algorithm> <array> <cmath> <filesystem> <functional> <limits> <map> <memory> <numeric> <optional> <span> <sstream>
          <string> <utility> <vector> <Eigen/Core>
          <Teuchos_CommHelpers.hpp> <Teuchos_ParameterList.hpp>
          <Tpetra_CrsMatrix.hpp> <Tpetra_Import.hpp> <Tpetra_Map.hpp> <Tpetra_Operator.hpp> <Tpetra_Vector.hpp>
  USES Epafi::trilinos Epafi::eigen)

# Where our headers are, and Trilinos: no library of ours, and no C++20. The headers of MueLu and Stratimikos in Trilinos 13.2
# are not C++20; units that include them and some of ours, those in C++17, link this.
add_library(epafi_headers INTERFACE)
add_library(Epafi::headers ALIAS epafi_headers)
target_include_directories(epafi_headers INTERFACE "$<BUILD_INTERFACE:${EPAFI_INCLUDE_ROOT}>")
target_link_libraries(epafi_headers INTERFACE Epafi::trilinos)
set_target_properties(epafi_headers PROPERTIES EXPORT_NAME headers)
if(EPAFI_INSTALL)
  epafi_install_library(epafi_headers headers USES Epafi::trilinos)
endif()

# epafi_unite(<target> [<number>]): its sources are compiled so many at a time, 20 if not given, which takes less time: what all of them instantiate is
# instantiated once. Names in their anonymous namespaces must differ for it.
function(epafi_unite target)
  if(EPAFI_UNITY)
    set(batch 20)
    if(ARGC GREATER 1)
      set(batch ${ARGV1})
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
    # What is in an anonymous namespace of a source seems to be one of a header then.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# epafi_library(<target> <name> SOURCES a.cpp ... USES Epafi::base ... [NEEDS Epafi::metis ...])
# Makes the library Epafi::<name>, static or shared as BUILD_SHARED_LIBS says. USES is what its headers name, NEEDS what its
# sources alone name.
function(epafi_library target name)
  cmake_parse_arguments(PARSE_ARGV 2 LIBRARY "" "" "SOURCES;USES;NEEDS")
  add_library(${target} ${LIBRARY_SOURCES})
  add_library(Epafi::${name} ALIAS ${target})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC Epafi::headers ${LIBRARY_USES} PRIVATE ${LIBRARY_NEEDS})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name}
    POSITION_INDEPENDENT_CODE ON
    DEFINE_SYMBOL "" # objects of static and of shared libraries are the same, and compiled once by ccache
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  epafi_own_code(${target})
  epafi_unite(${target})
  if(EPAFI_SANITIZE) # what a shared library calls of itself is sanitized, whatever else a program has of templates
    target_link_options(${target} PRIVATE -Wl,-Bsymbolic-functions)
  endif()
  if(EPAFI_INSTALL)
    epafi_install_library(${target} ${name} USES Epafi::headers ${LIBRARY_USES} NEEDS ${LIBRARY_NEEDS})
  endif()
endfunction()

# epafi_room(<room> SOURCES ... USES ... [NEEDS ...])
# The library of the folder, as above, and the include path epafi/<room>/; that of the room fetidp/solve is Epafi::fetidp_solve.
function(epafi_room room)
  cmake_parse_arguments(PARSE_ARGV 1 ROOM "" "" "SOURCES;USES;NEEDS")
  string(REPLACE "/" "_" name "${room}")
  cmake_path(GET room PARENT_PATH above)
  file(MAKE_DIRECTORY "${EPAFI_INCLUDE_ROOT}/epafi/${above}")
  file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}" "${EPAFI_INCLUDE_ROOT}/epafi/${room}" SYMBOLIC)
  epafi_library(epafi_${name} ${name} SOURCES ${ROOM_SOURCES} USES ${ROOM_USES} NEEDS ${ROOM_NEEDS})
  if(EPAFI_INSTALL)
    epafi_install_headers(${room})
  endif()
endfunction()
