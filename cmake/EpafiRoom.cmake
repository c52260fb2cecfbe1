# A room of the house is one library: its folder holds headers and sources side by side, and its headers are included as
# "epafi/<room>/<Name>.hpp" through a link in the build tree, so that a file has one address everywhere.

set(EPAFI_INCLUDE_ROOT "${PROJECT_BINARY_DIR}/include")
file(MAKE_DIRECTORY "${EPAFI_INCLUDE_ROOT}/epafi")

# Warnings and sanitizers for our own code.
function(epafi_own_code target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(EPAFI_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(EPAFI_SANITIZE)
    # GCC 12 takes sanitized code of Eigen for uninitialized. Null pointers and what lies outside of objects are what the
    # address sanitizer sees; without these checks, and that of alignment, code compiles in two thirds of the time.
    target_compile_options(${target} PRIVATE -fsanitize=${EPAFI_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize=null,alignment,object-size
                                             -fno-sanitize-recover=undefined -D_GLIBCXX_ASSERTIONS
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_link_options(${target} PRIVATE -fsanitize=${EPAFI_SANITIZE})
  endif()
endfunction()

# epafi_room(<room> SOURCES a.cpp b.cpp ... USES Epafi::base ...)
# Makes the library epafi_<room>, its alias Epafi::<room>, and the include path epafi/<room>/.
function(epafi_room room)
  cmake_parse_arguments(PARSE_ARGV 1 ROOM "" "" "SOURCES;USES")
  file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}" "${EPAFI_INCLUDE_ROOT}/epafi/${room}" SYMBOLIC)
  add_library(epafi_${room} STATIC ${ROOM_SOURCES})
  add_library(Epafi::${room} ALIAS epafi_${room})
  target_include_directories(epafi_${room} PUBLIC "$<BUILD_INTERFACE:${EPAFI_INCLUDE_ROOT}>")
  target_link_libraries(epafi_${room} PUBLIC ${ROOM_USES})
  set_target_properties(epafi_${room} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  epafi_own_code(epafi_${room})
endfunction()
