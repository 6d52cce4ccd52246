# Debian's requirements on the files of a package (Debian Policy, chapter 12); run by CPack on the files before packing.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(share ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}/usr/share)
  set(doc ${share}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  file(COPY ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${doc})
  file(WRITE ${doc}/changelog
       "tribound (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n  * See /usr/share/doc/tribound/CHANGELOG.md.\n\n"
       " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  file(GLOB manuals ${share}/man/man1/*.1)
  execute_process(COMMAND gzip --best --no-name --force ${doc}/changelog ${manuals} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
