# Gmsh's library, which has neither a pkg-config nor a config file on Debian. Defines Gmsh::Gmsh for targets that link it, and
# GMSH_SONAME, by which Tribound's library loads it when needed (mesh/gmsh_library.h).

find_path(GMSH_INCLUDE_DIR gmshc.h)
find_library(GMSH_LIBRARY gmsh)
mark_as_advanced(GMSH_INCLUDE_DIR GMSH_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Gmsh REQUIRED_VARS GMSH_LIBRARY GMSH_INCLUDE_DIR)

if(Gmsh_FOUND AND NOT TARGET Gmsh::Gmsh)
  add_library(Gmsh::Gmsh UNKNOWN IMPORTED)
  set_target_properties(Gmsh::Gmsh PROPERTIES IMPORTED_LOCATION ${GMSH_LIBRARY}
                                              INTERFACE_INCLUDE_DIRECTORIES ${GMSH_INCLUDE_DIR})
  execute_process(COMMAND ${CMAKE_OBJDUMP} -p ${GMSH_LIBRARY} OUTPUT_VARIABLE gmsh_headers ERROR_QUIET)
  if(gmsh_headers MATCHES "SONAME +([^\n ]+)")
    set(GMSH_SONAME ${CMAKE_MATCH_1})
  else()
    set(GMSH_SONAME ${GMSH_LIBRARY})
  endif()
endif()
