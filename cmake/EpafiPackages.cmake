# cpack -G DEB makes the Debian packages epafi (programs, scenes, documents) and libepafi-dev (static libraries, headers, what
# find_package(Epafi) reads). Of shared libraries it makes none: those belong to an installation of one's own.

if(BUILD_SHARED_LIBS)
  return()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME epafi)
set(CPACK_PACKAGE_VENDOR "The Epafi developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "contact problems by FETI-DP and quadratic programming")
set(CPACK_PACKAGE_CONTACT "The Epafi developers")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages-debian")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL programs development)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)

# What the programs link is asked of dpkg-shlibdeps. Gmsh is loaded at first use, when a scene has a geometry.
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME epafi)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS openmpi-bin)
get_target_property(gmsh Epafi::gmsh INTERFACE_COMPILE_DEFINITIONS)
string(REGEX REPLACE ".*EPAFI_GMSH_SONAME=\"libgmsh.so.([0-9.]+)\".*" "libgmsh\\1" gmsh "${gmsh}")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "${gmsh}, libopenblas0, python3-h5py, python3-matplotlib, python3-numpy")
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION "Epafi solves frictionless contact problems of elastic bodies and of
membranes, described by scenes in XML, on one or many processes. It cuts the
bodies into subdomains, joins them by FETI-DP, and finds the contact forces by
quadratic programming algorithms that stop with a certificate of their accuracy.

This package has the programs epafi and epafi-plot, scenes that work, and the
documentation.")

# What the static libraries link, and what headers and CMake's files name.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libepafi-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libboost-dev, libeigen3-dev, libhdf5-openmpi-dev, libmetis-dev, libopenmpi-dev, \
libptscotch-dev, libscotch-dev, libsuitesparse-dev, trilinos-all-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake, g++, libopenblas-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS epafi)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Epafi solves frictionless contact problems of elastic bodies and of
membranes by FETI-DP and optimal quadratic programming on Trilinos.

This package has the static libraries, the headers, and what CMake's
find_package(Epafi) reads.")

include(CPack)
