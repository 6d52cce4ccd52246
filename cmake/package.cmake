# The Debian package, by scripts/package. dpkg-shlibdeps finds the linked libraries of the program and the library.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tribound)
set(CPACK_PACKAGE_CONTACT "The Tribound authors <authors@tribound.invalid>") # they have no address
if(DEFINED ENV{DEBEMAIL}) # the builder of the package, as in Debian's own tools
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "certified frictional contact of elastic bodies")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "Tribound computes frictional contact of elastic bodies with rigid obstacles
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
set(CPACK_DEBIAN_PACKAGE_DEPENDS ${gmsh_package})
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libopenblas0-pthread, openmpi-bin, libeigen3-dev")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, g++, gmsh, paraview, python3:any, python3-matplotlib, python3-numpy, python3-vtk9")

set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian/files.cmake)
include(CPack)
