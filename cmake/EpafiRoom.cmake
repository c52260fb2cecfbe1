# A room of the house is one library: its folder holds headers and sources side by side, and its headers are included as
# "epafi/<room>/<Name>.hpp" through a link in the build tree, so that a file has one address everywhere, installed too.

set(EPAFI_INCLUDE_ROOT "${PROJECT_BINARY_DIR}/include")
file(MAKE_DIRECTORY "${EPAFI_INCLUDE_ROOT}/epafi")

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

# epafi_room(<room> [NAME <name>] SOURCES ... USES ... [NEEDS ...] [INTERNAL ...])
# INTERNAL are headers for the room's own sources, which are not installed. The library of the folder, as above, and the include path epafi/<room>/; that of the room fetidp/solve is Epafi::fetidp_solve,
# if it is not named otherwise.
function(epafi_room room)
  cmake_parse_arguments(PARSE_ARGV 1 ROOM "" "NAME" "SOURCES;USES;NEEDS;INTERNAL")
  string(REPLACE "/" "_" name "${room}")
  if(ROOM_NAME)
    set(name ${ROOM_NAME})
  endif()
  cmake_path(GET room PARENT_PATH above)
  if(IS_SYMLINK "${EPAFI_INCLUDE_ROOT}/epafi/${above}") # of a build tree from when it was one room
    file(REMOVE "${EPAFI_INCLUDE_ROOT}/epafi/${above}")
  endif()
  file(MAKE_DIRECTORY "${EPAFI_INCLUDE_ROOT}/epafi/${above}")
  file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}" "${EPAFI_INCLUDE_ROOT}/epafi/${room}" SYMBOLIC)
  epafi_library(epafi_${name} ${name} SOURCES ${ROOM_SOURCES} USES ${ROOM_USES} NEEDS ${ROOM_NEEDS})
  if(EPAFI_INSTALL)
    epafi_install_headers(${room} ${ROOM_INTERNAL})
  endif()
endfunction()
