# epafi_test(<name> SOURCES ... [ALONE ...] USES ... [RANKS 1 2 ...] [LABELS ...] [TIMEOUT seconds]); ALONE are sources whose names others
# have, too, so that they are compiled each for itself.
# One googletest program, run by ctest once for every number of ranks. The tests of a program are valid for any number.

find_package(GTest REQUIRED)

# Tests take longer to compile than to run: they are optimised less, and GCC 12 takes some of Eigen for uninitialized then. Sanitized is what
# they test, not they: their objects are those of the release.
function(epafi_test_code target)
  epafi_warnings(${target})
  if(EPAFI_SANITIZE)
    target_link_options(${target} PRIVATE -fsanitize=${EPAFI_SANITIZE})
  endif()
  target_include_directories(${target} PRIVATE "${Epafi_SOURCE_DIR}/test")
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_precompile_headers(${target} REUSE_FROM epafi_precompiled_tests)
endfunction()

epafi_precompiled_headers(epafi_precompiled_tests FLAGS epafi_warnings
  HEADERS <algorithm> <cmath> <limits> <map> <random> <set> <sstream> <string> <vector> <Eigen/Dense> <gtest/gtest.h>
          <Teuchos_CommHelpers.hpp> <Teuchos_ParameterList.hpp> <Tpetra_Core.hpp>
          <Tpetra_CrsMatrix.hpp> <Tpetra_Import.hpp> <Tpetra_Map.hpp> <Tpetra_Operator.hpp> <Tpetra_Vector.hpp>
  USES Epafi::trilinos Epafi::eigen GTest::gtest)
target_compile_options(epafi_precompiled_tests PRIVATE $<$<CONFIG:Release>:-O1>)

add_library(epafi_test_main STATIC "${Epafi_SOURCE_DIR}/test/main.cpp")
target_link_libraries(epafi_test_main PUBLIC Epafi::base GTest::gtest)
epafi_test_code(epafi_test_main)

# epafi_test_library(<target> SOURCES ... USES ...): what several test programs share.
function(epafi_test_library target)
  cmake_parse_arguments(PARSE_ARGV 1 TEST "" "" "SOURCES;USES")
  add_library(${target} STATIC EXCLUDE_FROM_ALL ${TEST_SOURCES})
  target_link_libraries(${target} PUBLIC GTest::gtest ${TEST_USES})
  target_compile_definitions(${target} PRIVATE EPAFI_SOURCE_DIR="${Epafi_SOURCE_DIR}")
  epafi_test_code(${target})
  epafi_unite(${target})
endfunction()

set(EPAFI_MPIRUN_FLAGS --oversubscribe --bind-to none)
# On one machine nobody needs to look for fast networks and X servers, which takes longer than most tests, and what a container does not
# tell of its processors and networks is not for the output. Ranks that wait for others make way for these: on a busy machine small messages
# take thirty times as long otherwise.
set(EPAFI_TEST_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_pml=ob1 OMPI_MCA_mpi_yield_when_idle=1
    HWLOC_COMPONENTS=-gl HWLOC_HIDE_ERRORS=2 UCX_LOG_LEVEL=fatal OPENBLAS_NUM_THREADS=1)

function(epafi_test name)
  cmake_parse_arguments(PARSE_ARGV 1 TEST "" "TIMEOUT" "SOURCES;ALONE;USES;RANKS;LABELS")
  if(NOT TEST_RANKS)
    set(TEST_RANKS 1)
  endif()
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 600) # against hanging; a loaded machine is slow
  endif()
  add_executable(test_${name} ${TEST_SOURCES} ${TEST_ALONE})
  set_property(DIRECTORY APPEND PROPERTY EPAFI_TEST_SOURCES ${TEST_SOURCES} ${TEST_ALONE})
  target_link_libraries(test_${name} PRIVATE epafi_test_main ${TEST_USES})
  target_compile_definitions(test_${name} PRIVATE EPAFI_SOURCE_DIR="${Epafi_SOURCE_DIR}")
  epafi_test_code(test_${name})
  epafi_unite(test_${name} 12)
  set_source_files_properties(${TEST_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  foreach(ranks IN LISTS TEST_RANKS)
    set(leaks "")
    if(EPAFI_SANITIZE AND ranks EQUAL 1 AND NOT name MATCHES "qp|forms|friction|system|assembly|accuracy|simulation"
       AND NOT "random" IN_LIST TEST_LABELS)
      set(leaks leaks) # runs once, with leaks looked for; CAD, patches, random problems and whole runs allocate too often for that
    endif()
    add_test(NAME ${name}_np${ranks}
             COMMAND ${MPIEXEC_EXECUTABLE} ${EPAFI_MPIRUN_FLAGS} ${MPIEXEC_NUMPROC_FLAG} ${ranks}
                     $<TARGET_FILE:test_${name}>)
    set_tests_properties(${name}_np${ranks} PROPERTIES PROCESSORS ${ranks} TIMEOUT ${TEST_TIMEOUT}
      LABELS "${TEST_LABELS};${leaks}"
      ENVIRONMENT "${EPAFI_TEST_ENVIRONMENT}")
  endforeach()
endfunction()
