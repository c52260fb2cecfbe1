# How our own code is compiled, in the house as in drivers/study: the language, warnings, sanitizers, and what is read once for many units.

option(EPAFI_UNITY "Compile the sources of a room several at a time; OFF where single files are changed again and again" ON)
option(EPAFI_WARNINGS_AS_ERRORS "Treat warnings in Epafi's own code as errors, as .ci/run does" OFF)
set(EPAFI_SANITIZE "" CACHE STRING "Sanitizers for Epafi's own code, e.g. address,undefined; empty for none")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

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
