# The Debian packages, by scripts/package: tribound, and python3-tribound where the module is built. dpkg-shlibdeps finds the
# linked libraries of the program, the library and the module.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tribound)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tribound)
set(CPACK_PACKAGE_CONTACT "The Tribound authors <authors@tribound.invalid>") # they have no address
if(DEFINED ENV{DEBEMAIL}) # the builder of the package, as in Debian's own tools
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own, the first line of its description
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
    "certified frictional contact of elastic bodies
Tribound computes frictional contact of elastic bodies with rigid obstacles
and with each other, in 2D and 3D, by Nitsche's finite element method of
degree 1 to 4. The result comes with a guaranteed bound on the error, which
also adapts the mesh.

The package has the program, its guide and examples, and the library for C++.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# Gmsh's library is loaded by its soname, from which Debian derives the package name; for the others see docs/decisions.md.
string(REPLACE ".so." "" gmsh_package ${GMSH_SONAME})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS ${gmsh_package})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libopenblas0-pthread, openmpi-bin, libeigen3-dev")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS
    "cmake, g++, gmsh, paraview, python3:any, python3-matplotlib, python3-numpy, python3-tribound, python3-vtk9")

# The module is for one version of Python, and for the library of the same build.
if(TARGET tribound_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_COMPONENT_PYTHON_DEPENDS program)
  set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-tribound)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), python3 (<< ${Python3_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-matplotlib")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-cloudpickle, python3-meshio, python3-mpi4py, python3-pandas, python3-vtk9")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/postinst ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION
      "certified frictional contact from Python
Tribound computes frictional contact of elastic bodies with rigid obstacles
and with each other, with a guaranteed bound on the error.

The package has the module tribound for Python: cases and meshes from Python's
own data, loads by functions, results as arrays of NumPy.")
endif()

set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian/files.cmake)
include(CPack)
