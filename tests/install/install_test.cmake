# cmake -D BUILD= -D SOURCE= -D SCRATCH= -D GENERATOR= -D COMPILER= -P install_test.cmake

function(step)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix)
foreach(file share/man/man1/tribound.1 share/bash-completion/completions/tribound share/zsh/site-functions/_tribound
             share/doc/tribound/docs/case-format.md share/doc/tribound/docs/images/report.png
             share/doc/tribound/examples/05_dam/case.toml share/tribound/picture share/tribound/tribound.schema.json)
  if(NOT EXISTS ${SCRATCH}/prefix/${file})
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()
execute_process(COMMAND ${SCRATCH}/prefix/bin/tribound --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
if(NOT help MATCHES "${SCRATCH}/prefix/share/doc/tribound/docs")
  message(FATAL_ERROR "--help does not say where the guide is installed:\n${help}")
endif()
step(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${SCRATCH}/build -D CMAKE_BUILD_TYPE=Release
     -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_PREFIX_PATH=${SCRATCH}/prefix)
step(${CMAKE_COMMAND} --build ${SCRATCH}/build)
step(${SCRATCH}/build/certified_block)
step(${SCRATCH}/build/own_loop)
step(${SCRATCH}/build/load_path)
