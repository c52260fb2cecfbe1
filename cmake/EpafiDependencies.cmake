# Third-party libraries, each behind one target Epafi::<name>. The targets are IMPORTED: their headers are SYSTEM, since
# warnings are errors in our own code only, and nothing of them is exported. An installed Epafi comes with this file
# and finds again, wherever it is used, what the asked libraries need.
#
# epafi_dependency(<name> <missing>): makes Epafi::<name> unless there is one. The variable <missing> gets one sentence
# on what is not found, and is empty otherwise.

# Packages of Trilinos, by the target that they make.
set(epafi_packages_trilinos Tpetra Belos) # all that base and qp need
set(epafi_packages_amesos2 Amesos2)
set(epafi_packages_thyra ThyraTpetraAdapters)
set(epafi_packages_muelu MueLu) # for drivers/study alone
set(epafi_packages_stratimikos Stratimikos) # for Epafi::adapters alone
set(epafi_packages_frosch ShyLU_DDFROSch) # likewise

function(epafi_dependency name missing)
  set(sentence "")
  if(TARGET Epafi::${name})
    # It is there.
  elseif(DEFINED epafi_packages_${name})
    epafi_find_in_trilinos(${name} sentence)
  else()
    cmake_language(CALL epafi_find_${name} sentence)
  endif()
  set(${missing} "${sentence}" PARENT_SCOPE)
endfunction()

# epafi_imported(<name> INCLUDES ... LIBRARIES ... DEFINITIONS ...)
function(epafi_imported name)
  cmake_parse_arguments(PARSE_ARGV 1 IMPORTED "" "" "INCLUDES;LIBRARIES;DEFINITIONS")
  add_library(Epafi::${name} INTERFACE IMPORTED GLOBAL) # for projects of which Epafi is a subdirectory
  target_include_directories(Epafi::${name} INTERFACE ${IMPORTED_INCLUDES})
  target_link_libraries(Epafi::${name} INTERFACE ${IMPORTED_LIBRARIES})
  target_compile_definitions(Epafi::${name} INTERFACE ${IMPORTED_DEFINITIONS})
endfunction()

# ---------------------------------------------------------------------------------------------------------------------
# Trilinos

# TrilinosConfig.cmake reads its packages but once in a directory, those that whoever came first has asked for. Their files
# are therefore read here one by one.
function(epafi_find_in_trilinos name missing)
  if(NOT TARGET MPI::MPI_CXX) # it compiles programs to see, each time that it is asked
    find_package(MPI QUIET COMPONENTS CXX)
  endif()
  if(NOT TARGET MPI::MPI_CXX)
    set(${missing} "MPI for C++ is not found; name its compiler in MPI_CXX_COMPILER (Debian: libopenmpi-dev)" PARENT_SCOPE)
    return()
  endif()
  find_package(Trilinos QUIET CONFIG COMPONENTS Teuchos)
  if(NOT Trilinos_FOUND OR Trilinos_VERSION VERSION_LESS 13.2)
    set(${missing} "Trilinos 13.2 or later is not found; name its prefix in CMAKE_PREFIX_PATH (Debian: trilinos-all-dev)"
        PARENT_SCOPE)
    return()
  endif()
  set(includes "")
  set(libraries "")
  foreach(package IN LISTS epafi_packages_${name})
    set(file "${Trilinos_DIR}/../${package}/${package}Config.cmake")
    if(NOT EXISTS "${file}")
      set(${missing} "Trilinos ${Trilinos_VERSION} in ${Trilinos_DIR} comes without ${package}; build it with \
-DTrilinos_ENABLE_${package}=ON, or name another one in CMAKE_PREFIX_PATH" PARENT_SCOPE)
      return()
    endif()
    include("${file}")
    if(TARGET ${package}::all_libs) # from Trilinos 14 on
      list(APPEND libraries ${package}::all_libs)
    else()
      foreach(directory IN LISTS ${package}_INCLUDE_DIRS ${package}_TPL_INCLUDE_DIRS)
        get_filename_component(directory "${directory}" ABSOLUTE) # they are full of ..
        list(APPEND includes "${directory}")
      endforeach()
      list(APPEND libraries ${${package}_LIBRARIES} ${${package}_TPL_LIBRARIES})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES includes)
  list(REMOVE_DUPLICATES libraries)
  # The C++ bindings that old versions of Open MPI have are not for us.
  epafi_imported(${name} INCLUDES ${includes} LIBRARIES ${libraries} MPI::MPI_CXX DEFINITIONS OMPI_SKIP_MPICXX)
endfunction()

# ---------------------------------------------------------------------------------------------------------------------
# Others

function(epafi_find_eigen missing)
  find_package(Eigen3 QUIET NO_MODULE) # whose versions 3.4 and 5 do not stand for each other
  if(NOT TARGET Eigen3::Eigen OR Eigen3_VERSION VERSION_LESS 3.4)
    set(${missing} "Eigen 3.4 or later is not found; name its prefix in CMAKE_PREFIX_PATH (Debian: libeigen3-dev)" PARENT_SCOPE)
    return()
  endif()
  epafi_imported(eigen LIBRARIES Eigen3::Eigen)
endfunction()

# Sparse Cholesky factors of subdomains. Its dense parts go through the BLAS that Trilinos names; OpenBLAS it should be.
function(epafi_find_cholmod missing)
  find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
  find_library(CHOLMOD_LIBRARY cholmod)
  if(NOT CHOLMOD_INCLUDE_DIR OR NOT CHOLMOD_LIBRARY)
    set(${missing} "CHOLMOD is not found; name SuiteSparse's prefix in CMAKE_PREFIX_PATH (Debian: libsuitesparse-dev)"
        PARENT_SCOPE)
    return()
  endif()
  find_package(OpenMP QUIET COMPONENTS CXX) # its run-time library alone, to keep CHOLMOD from making threads
  if(NOT OpenMP_CXX_FOUND)
    set(OpenMP_CXX_LIBRARIES gomp) # CHOLMOD's own, where another compiler than GCC brings none
  endif()
  epafi_imported(cholmod INCLUDES "${CHOLMOD_INCLUDE_DIR}" LIBRARIES "${CHOLMOD_LIBRARY}" ${OpenMP_CXX_LIBRARIES})
endfunction()

function(epafi_find_metis missing)
  find_path(METIS_INCLUDE_DIR metis.h)
  find_library(METIS_LIBRARY metis)
  if(NOT METIS_INCLUDE_DIR OR NOT METIS_LIBRARY)
    set(${missing} "METIS is not found; name its prefix in CMAKE_PREFIX_PATH (Debian: libmetis-dev)" PARENT_SCOPE)
    return()
  endif()
  epafi_imported(metis INCLUDES "${METIS_INCLUDE_DIR}" LIBRARIES "${METIS_LIBRARY}")
endfunction()

# Headers alone, of Boost.Geometry.
function(epafi_find_boost missing)
  find_path(BOOST_GEOMETRY_INCLUDE_DIR boost/geometry/index/rtree.hpp)
  if(NOT BOOST_GEOMETRY_INCLUDE_DIR)
    set(${missing} "Boost's headers are not found; name their prefix in CMAKE_PREFIX_PATH (Debian: libboost-dev)" PARENT_SCOPE)
    return()
  endif()
  epafi_imported(boost INCLUDES "${BOOST_GEOMETRY_INCLUDE_DIR}")
endfunction()

# Packed input decks.
function(epafi_find_zlib missing)
  find_path(ZLIB_INCLUDE_DIR zlib.h)
  find_library(ZLIB_LIBRARY z)
  if(NOT ZLIB_INCLUDE_DIR OR NOT ZLIB_LIBRARY)
    set(${missing} "zlib is not found; name its prefix in CMAKE_PREFIX_PATH (Debian: zlib1g-dev)" PARENT_SCOPE)
    return()
  endif()
  epafi_imported(zlib INCLUDES "${ZLIB_INCLUDE_DIR}" LIBRARIES "${ZLIB_LIBRARY}")
endfunction()

# Fields are written by all ranks at once, which takes the parallel HDF5.
function(epafi_find_hdf5 missing)
  if(NOT CMAKE_C_COMPILER_LOADED)
    set(${missing} "HDF5 is found by C alone; name C beside CXX in project()" PARENT_SCOPE)
    return()
  endif()
  set(HDF5_PREFER_PARALLEL TRUE)
  find_package(HDF5 QUIET COMPONENTS C)
  if(NOT HDF5_FOUND OR NOT HDF5_IS_PARALLEL)
    set(${missing} "no parallel HDF5 is found, which writes the fields; name one in HDF5_ROOT (Debian: libhdf5-openmpi-dev)"
        PARENT_SCOPE)
    return()
  endif()
  epafi_imported(hdf5 INCLUDES ${HDF5_C_INCLUDE_DIRS} LIBRARIES ${HDF5_C_LIBRARIES})
endfunction()

# Gmsh reads geometries. It is loaded at first use and not linked, because it brings some eighty other libraries along:
# what counts is the name by which the run-time linker knows it.
function(epafi_find_gmsh missing)
  find_path(GMSH_INCLUDE_DIR gmshc.h)
  find_library(GMSH_LIBRARY gmsh)
  if(NOT GMSH_INCLUDE_DIR OR NOT GMSH_LIBRARY)
    set(${missing} "Gmsh is not found; name its prefix in CMAKE_PREFIX_PATH (Debian: libgmsh-dev)" PARENT_SCOPE)
    return()
  endif()
  file(REAL_PATH "${GMSH_LIBRARY}" file)
  get_filename_component(soname "${file}" NAME)
  if(CMAKE_READELF)
    execute_process(COMMAND "${CMAKE_READELF}" -d "${file}" OUTPUT_VARIABLE header ERROR_QUIET)
    if(header MATCHES "SONAME[^[]*\\[([^]]+)\\]")
      set(soname "${CMAKE_MATCH_1}")
    endif()
  endif()
  epafi_imported(gmsh INCLUDES "${GMSH_INCLUDE_DIR}"
                 DEFINITIONS EPAFI_GMSH_SONAME="${soname}" EPAFI_GMSH_FILE="${file}")
endfunction()
