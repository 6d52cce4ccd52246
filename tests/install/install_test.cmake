# cmake -D BUILD= -D SCRATCH= -D LINKS= -D GENERATOR= -D COMPILER= [-D PYTHON=] -P install_test.cmake     PYTHON: that of the module

function(step)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix)
step(${LINKS} --sources ${SCRATCH}/prefix/share/doc/tribound)
set(use ${CMAKE_CURRENT_LIST_DIR}/use_installation.sh)
step(${use} program ${SCRATCH}/prefix ${SCRATCH})
step(${use} library ${SCRATCH}/prefix ${SCRATCH} -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${COMPILER})
if(PYTHON)
  step(${use} module ${SCRATCH}/prefix ${SCRATCH} ${PYTHON})
endif()
