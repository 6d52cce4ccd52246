# All dependencies of Tribound; scripts/setup installs them on Debian.

find_program(CCACHE ccache)
if(CCACHE)
  # Without these two, ccache does not cache files that use a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
pkg_search_module(MPI REQUIRED IMPORTED_TARGET mpi-c ompi-c mpich)
pkg_search_module(PETSC REQUIRED IMPORTED_TARGET PETSc petsc)
pkg_check_modules(LAPACK REQUIRED IMPORTED_TARGET lapack blas)
pkg_check_modules(DEFLATE REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(PUGIXML REQUIRED IMPORTED_TARGET pugixml)
pkg_search_module(HDF5 REQUIRED IMPORTED_TARGET hdf5-openmpi hdf5-mpi) # with MPI, as in PETSc
pkg_check_modules(EIGEN REQUIRED IMPORTED_TARGET eigen3>=3.4)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}) # FindGmsh.cmake
find_package(Gmsh REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(OpenMP REQUIRED COMPONENTS CXX)

# The Python module is optional: it is built where pybind11 is found, for Debian's Python, which has NumPy and the others.
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 COMPONENTS Interpreter Development.Module)
if(Python3_Development.Module_FOUND)
  find_package(pybind11 2.10 CONFIG)
endif()
if(pybind11_FOUND)
  set(has_pybind11 ON)
else()
  set(has_pybind11 OFF)
endif()
option(TRIBOUND_PYTHON "Build the Python module" ${has_pybind11})
