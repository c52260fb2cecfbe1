# Where things go when they are installed: programs, scenes and documents are the component `programs`; libraries, headers
# and what find_package(Epafi) reads are the component `development`.

# Debian has its libraries in lib/<architecture>, under any prefix that the linker and CMake search.
if(PROJECT_IS_TOP_LEVEL)
  if(EXISTS /etc/debian_version AND CMAKE_LIBRARY_ARCHITECTURE)
    set(CMAKE_INSTALL_LIBDIR "lib/${CMAKE_LIBRARY_ARCHITECTURE}" CACHE PATH "Libraries, below the prefix")
  endif()
  set(CMAKE_INSTALL_DOCDIR "share/doc/epafi" CACHE PATH "Documents, below the prefix")
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(EPAFI_INSTALL_CMAKEDIR "${CMAKE_INSTALL_LIBDIR}/cmake/Epafi")
set(EPAFI_INSTALL_DATADIR "${CMAKE_INSTALL_DATADIR}/epafi")

# Programs find shared libraries of ours by their place beside them, wherever the whole is moved.
if(BUILD_SHARED_LIBS)
  file(RELATIVE_PATH epafi_libraries_from_programs "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
  list(PREPEND CMAKE_INSTALL_RPATH "$ORIGIN" "$ORIGIN/${epafi_libraries_from_programs}")
endif()

# epafi_install_library(<target> <name> USES ... NEEDS ...): every library has an export set of its own, so that
# EpafiConfig.cmake can read those that are asked for alone. What they use it learns from the property EPAFI_USES; a shared
# library brings what it needs.
function(epafi_install_library target name)
  cmake_parse_arguments(PARSE_ARGV 2 LIBRARY "" "" "USES;NEEDS")
  install(TARGETS ${target} EXPORT Epafi-${name}
          ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development
          LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development
          INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(EXPORT Epafi-${name} NAMESPACE Epafi:: FILE EpafiTargets-${name}.cmake
          DESTINATION "${EPAFI_INSTALL_CMAKEDIR}" COMPONENT development)
  export(EXPORT Epafi-${name} NAMESPACE Epafi:: FILE "${PROJECT_BINARY_DIR}/EpafiTargets-${name}.cmake") # find_package(Epafi) may name the build, too
  set(uses ${LIBRARY_USES})
  if(NOT BUILD_SHARED_LIBS)
    list(APPEND uses ${LIBRARY_NEEDS})
  endif()
  list(TRANSFORM uses REPLACE "^Epafi::" "")
  list(JOIN uses " " uses)
  set_property(GLOBAL APPEND PROPERTY EPAFI_LIBRARIES ${name})
  set_property(GLOBAL APPEND_STRING PROPERTY EPAFI_USES "set(epafi_uses_${name} ${uses})\n")
endfunction()

# epafi_install_headers(<room> [<header> ...]): those of the current folder but the named ones.
function(epafi_install_headers room)
  file(GLOB headers CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.hpp")
  foreach(internal IN LISTS ARGN)
    list(REMOVE_ITEM headers "${CMAKE_CURRENT_SOURCE_DIR}/${internal}")
  endforeach()
  install(FILES ${headers} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/epafi/${room}" COMPONENT development)
endfunction()

# What find_package(Epafi) reads; called once all libraries are known.
function(epafi_install_config)
  get_property(EPAFI_LIBRARIES GLOBAL PROPERTY EPAFI_LIBRARIES)
  get_property(EPAFI_USES GLOBAL PROPERTY EPAFI_USES)
  configure_file("${PROJECT_SOURCE_DIR}/cmake/EpafiConfig.cmake.in" "${PROJECT_BINARY_DIR}/EpafiConfig.cmake" @ONLY)
  # Before 1.0 the second number counts what is not compatible.
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/EpafiConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
  file(CREATE_LINK "${PROJECT_SOURCE_DIR}/cmake/EpafiDependencies.cmake" "${PROJECT_BINARY_DIR}/EpafiDependencies.cmake" SYMBOLIC)
  install(FILES "${PROJECT_BINARY_DIR}/EpafiConfig.cmake" "${PROJECT_BINARY_DIR}/EpafiConfigVersion.cmake"
                "${PROJECT_SOURCE_DIR}/cmake/EpafiDependencies.cmake"
          DESTINATION "${EPAFI_INSTALL_CMAKEDIR}" COMPONENT development)
endfunction()

# Scenes and documents.
function(epafi_install_texts)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/xml" DESTINATION "${EPAFI_INSTALL_DATADIR}" COMPONENT programs)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs)
  install(FILES "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${PROJECT_SOURCE_DIR}/CONTRIBUTING.md"
                "${PROJECT_SOURCE_DIR}/CITATION.cff" "${PROJECT_SOURCE_DIR}/LICENSE"
          DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs)
  # Where Debian has the licence of a package.
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/epafi" RENAME copyright
          COMPONENT programs)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libepafi-dev" RENAME copyright
          COMPONENT development)
endfunction()
