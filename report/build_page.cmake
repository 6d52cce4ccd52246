# cmake -D NODE= -D NPM= -D SOURCE= -D FILES= -D PACKAGE= -D PAGE= -P build_page.cmake
#
# Copies the package to PACKAGE, installs what it stands on and builds PAGE. When that is not possible, says so and succeeds:
# the page is an extra.

# Runs a command in PACKAGE; its output goes to a log.
function(step name)
  execute_process(
    COMMAND ${ARGN}
    WORKING_DIRECTORY ${PACKAGE}
    OUTPUT_FILE ${PACKAGE}/${name}.log
    ERROR_FILE ${PACKAGE}/${name}.log
    RESULT_VARIABLE failed)
  if(failed)
    file(REMOVE ${PAGE})
    message(STATUS "Report page left out: ${name} failed, see ${PACKAGE}/${name}.log; cmake tries again when it configures")
  endif()
  set(failed ${failed} PARENT_SCOPE)
endfunction()

foreach(file ${FILES})
  get_filename_component(folder ${PACKAGE}/${file} DIRECTORY)
  file(COPY ${SOURCE}/${file} DESTINATION ${folder})
endforeach()

# npm ci takes the versions of package-lock.json; it is left out where they are there already.
file(SHA256 ${PACKAGE}/package-lock.json wanted)
set(installed "")
if(EXISTS ${PACKAGE}/node_modules/.installed)
  file(READ ${PACKAGE}/node_modules/.installed installed)
endif()
if(NOT installed STREQUAL wanted)
  step(npm_ci ${NPM} ci --prefer-offline --fetch-retries=1 --fetch-timeout=30000)
  if(failed)
    return()
  endif()
  file(WRITE ${PACKAGE}/node_modules/.installed ${wanted})
endif()
step(page_build ${NODE} build.mjs ${PAGE})
