# Third-party libraries, each behind one imported target whose headers are SYSTEM: warnings are errors in our own
# code only.

find_package(MPI REQUIRED COMPONENTS CXX)
find_package(Trilinos REQUIRED COMPONENTS Teuchos Tpetra Amesos2 Belos Thyra)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)

# Trilinos names some libraries many times over; once is enough. Its Thyra component also names Epetra wrappers, which
# Epafi never uses.
set(epafi_trilinos_libraries ${Trilinos_LIBRARIES} ${Trilinos_TPL_LIBRARIES})
list(REMOVE_DUPLICATES epafi_trilinos_libraries)
add_library(epafi_trilinos INTERFACE)
add_library(Epafi::trilinos ALIAS epafi_trilinos)
target_include_directories(epafi_trilinos SYSTEM INTERFACE ${Trilinos_INCLUDE_DIRS} ${Trilinos_TPL_INCLUDE_DIRS})
target_link_libraries(epafi_trilinos INTERFACE ${epafi_trilinos_libraries} MPI::MPI_CXX)
# Trilinos 13.2 hides Tpetra::Map::getLocalNumElements under an older name; see base/Compatibility.hpp.
target_compile_definitions(epafi_trilinos INTERFACE OMPI_SKIP_MPICXX)

# Algebraic multigrid, for the studies and examples alone: no room of the library links it.
find_package(MueLu REQUIRED HINTS ${Trilinos_DIR}/../MueLu)
set(epafi_muelu_libraries ${MueLu_LIBRARIES} ${MueLu_TPL_LIBRARIES})
list(REMOVE_DUPLICATES epafi_muelu_libraries)
add_library(epafi_muelu INTERFACE)
add_library(Epafi::muelu ALIAS epafi_muelu)
target_include_directories(epafi_muelu SYSTEM INTERFACE ${MueLu_INCLUDE_DIRS} ${MueLu_TPL_INCLUDE_DIRS})
target_link_libraries(epafi_muelu INTERFACE ${epafi_muelu_libraries} Epafi::trilinos)

# Linear solvers by name, for Epafi::adapters alone.
find_package(Stratimikos REQUIRED HINTS ${Trilinos_DIR}/../Stratimikos)
set(epafi_stratimikos_libraries ${Stratimikos_LIBRARIES} ${Stratimikos_TPL_LIBRARIES})
list(REMOVE_DUPLICATES epafi_stratimikos_libraries)
add_library(epafi_stratimikos INTERFACE)
add_library(Epafi::stratimikos ALIAS epafi_stratimikos)
target_include_directories(epafi_stratimikos SYSTEM INTERFACE ${Stratimikos_INCLUDE_DIRS} ${Stratimikos_TPL_INCLUDE_DIRS})
target_link_libraries(epafi_stratimikos INTERFACE ${epafi_stratimikos_libraries} Epafi::trilinos)

# Overlapping Schwarz, for a side-by-side run alone.
find_package(ShyLU_DDFROSch REQUIRED HINTS ${Trilinos_DIR}/../ShyLU_DDFROSch)
set(epafi_frosch_libraries ${ShyLU_DDFROSch_LIBRARIES} ${ShyLU_DDFROSch_TPL_LIBRARIES})
list(REMOVE_DUPLICATES epafi_frosch_libraries)
add_library(epafi_frosch INTERFACE)
add_library(Epafi::frosch ALIAS epafi_frosch)
target_include_directories(epafi_frosch SYSTEM INTERFACE ${ShyLU_DDFROSch_INCLUDE_DIRS} ${ShyLU_DDFROSch_TPL_INCLUDE_DIRS})
target_link_libraries(epafi_frosch INTERFACE ${epafi_frosch_libraries} Epafi::trilinos)

# Sparse Cholesky factors of subdomains. Its dense parts go through the BLAS that Trilinos names; OpenBLAS it should be.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_package(OpenMP COMPONENTS CXX) # its run-time library alone, to keep CHOLMOD from making threads
if(NOT OpenMP_CXX_FOUND)
  set(OpenMP_CXX_LIBRARIES gomp) # CHOLMOD's own, where another compiler than GCC brings none
endif()
add_library(epafi_cholmod INTERFACE)
add_library(Epafi::cholmod ALIAS epafi_cholmod)
target_include_directories(epafi_cholmod SYSTEM INTERFACE "${CHOLMOD_INCLUDE_DIR}")
target_link_libraries(epafi_cholmod INTERFACE "${CHOLMOD_LIBRARY}" ${OpenMP_CXX_LIBRARIES})

find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
find_library(METIS_LIBRARY metis REQUIRED)
add_library(epafi_metis INTERFACE)
add_library(Epafi::metis ALIAS epafi_metis)
target_include_directories(epafi_metis SYSTEM INTERFACE "${METIS_INCLUDE_DIR}")
target_link_libraries(epafi_metis INTERFACE "${METIS_LIBRARY}")

# Fields are written by all ranks at once, which takes the parallel HDF5.
set(HDF5_PREFER_PARALLEL TRUE)
find_package(HDF5 REQUIRED COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "Epafi writes its fields with parallel HDF5, but the HDF5 found is a serial one. "
                      "Install libhdf5-openmpi-dev or set HDF5_ROOT.")
endif()
add_library(epafi_hdf5 INTERFACE)
add_library(Epafi::hdf5 ALIAS epafi_hdf5)
target_include_directories(epafi_hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
target_link_libraries(epafi_hdf5 INTERFACE ${HDF5_C_LIBRARIES})

# Gmsh reads mesh files. It is loaded at first use and not linked, because it brings some eighty other libraries along:
# what counts is the name by which the run-time linker knows it.
find_path(GMSH_INCLUDE_DIR gmshc.h REQUIRED)
find_library(GMSH_LIBRARY gmsh REQUIRED)
file(REAL_PATH "${GMSH_LIBRARY}" epafi_gmsh_file)
get_filename_component(epafi_gmsh_soname "${epafi_gmsh_file}" NAME)
if(CMAKE_READELF)
  execute_process(COMMAND "${CMAKE_READELF}" -d "${epafi_gmsh_file}" OUTPUT_VARIABLE epafi_gmsh_header ERROR_QUIET)
  if(epafi_gmsh_header MATCHES "SONAME[^[]*\\[([^]]+)\\]")
    set(epafi_gmsh_soname "${CMAKE_MATCH_1}")
  endif()
endif()
add_library(epafi_gmsh INTERFACE)
add_library(Epafi::gmsh ALIAS epafi_gmsh)
target_include_directories(epafi_gmsh SYSTEM INTERFACE "${GMSH_INCLUDE_DIR}")
target_compile_definitions(epafi_gmsh INTERFACE EPAFI_GMSH_SONAME="${epafi_gmsh_soname}"
                                                EPAFI_GMSH_FILE="${epafi_gmsh_file}")
target_link_libraries(epafi_gmsh INTERFACE ${CMAKE_DL_LIBS})

# Debian's own interpreter: it has Debian's matplotlib and h5py, another python3 on the PATH may not.
find_program(EPAFI_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
