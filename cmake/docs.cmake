# The target docs: the guide and the reference of the library, by scripts/docs.

find_program(DOXYGEN doxygen)
find_path(DOXYGEN_THEME doxygen-awesome.css PATHS /usr/local/share /usr/share PATH_SUFFIXES doxygen-awesome-css)
find_path(MATHJAX MathJax.js PATHS /usr/local/share /usr/share PATH_SUFFIXES javascript/mathjax)
mark_as_advanced(DOXYGEN DOXYGEN_THEME MATHJAX)
if(DOXYGEN AND DOXYGEN_THEME AND MATHJAX)
  set(docs_command ${CMAKE_COMMAND} -E env DOXYGEN_THEME=${DOXYGEN_THEME} MATHJAX=${MATHJAX}
                   ${PROJECT_SOURCE_DIR}/scripts/docs)
  add_custom_target(docs COMMAND ${docs_command} USES_TERMINAL VERBATIM)
else()
  message(STATUS "No target docs: it needs Doxygen, doxygen-awesome-css and MathJax (scripts/setup)")
endif()
