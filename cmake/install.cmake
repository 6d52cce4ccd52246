# The program, the library with its headers, and the package that find_package(tribound) looks for.

include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tribound)

set_target_properties(tribound PROPERTIES VERSION ${PROJECT_VERSION}
                                          SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
install(TARGETS tribound EXPORT tribound)
if(TARGET tribound_app)
  # Only a shared library needs this: the installed tree may be moved.
  set_target_properties(tribound_app PROPERTIES INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR})
  install(TARGETS tribound_app)
  configure_file(${PROJECT_SOURCE_DIR}/docs/man/tribound.1.in ${PROJECT_BINARY_DIR}/tribound.1 @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/tribound.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${PROJECT_SOURCE_DIR}/app/completions/tribound.bash
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME tribound)
  install(FILES ${PROJECT_BINARY_DIR}/tribound.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/tribound)
  install(FILES ${PROJECT_SOURCE_DIR}/app/completions/_tribound DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
endif()

# Files that the program runs (app/result/figures.cpp), and the script of pictures.
install(PROGRAMS ${PROJECT_SOURCE_DIR}/scripts/study_figures ${PROJECT_SOURCE_DIR}/scripts/picture
        DESTINATION ${CMAKE_INSTALL_DATADIR}/tribound)
foreach(module raster result_charts result_files result_picture result_surface study_bodies study_charts study_fields)
  install(FILES ${PROJECT_SOURCE_DIR}/scripts/${module}.py DESTINATION ${CMAKE_INSTALL_DATADIR}/tribound)
endforeach()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/tribound
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h" PATTERN "*.templates.h" EXCLUDE)

install(EXPORT tribound NAMESPACE tribound:: FILE tribound-targets.cmake DESTINATION ${package_dir})
get_target_property(library_type tribound TYPE)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/tribound-config.cmake.in
                              ${PROJECT_BINARY_DIR}/tribound-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tribound-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tribound-config.cmake ${PROJECT_BINARY_DIR}/tribound-config-version.cmake
        DESTINATION ${package_dir})

# The guide, the examples and everything else it refers to, arranged as in the sources.
install(FILES CHANGELOG.md CITATION.cff CONTRIBUTING.md COPYING LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES src/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/src)
install(FILES bench/README.md bench/block3d.toml DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/bench/peers/judged DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench/peers PATTERN "mesh.msh" EXCLUDE
                                                                                              PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.ipynb" PATTERN "*.png"
                                                                                          PATTERN "*.svg" PATTERN "*.bib")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN "out" EXCLUDE
                                                                                           PATTERN "__pycache__" EXCLUDE)
