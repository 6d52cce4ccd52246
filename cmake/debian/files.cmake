# Debian's requirements on the files of a package (Debian Policy, chapter 12); run by CPack on the files before packing.
set(share ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share)
set(doc ${share}/doc/tribound)

file(COPY ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${doc})
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(
  WRITE ${doc}/changelog
  "tribound (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n  * See /usr/share/doc/tribound/CHANGELOG.md.\n\n"
  " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
execute_process(COMMAND gzip --best --no-name --force ${doc}/changelog ${share}/man/man1/tribound.1
                COMMAND_ERROR_IS_FATAL ANY)
