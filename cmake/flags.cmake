# Compiler flags common to all targets of this repository.

add_library(tribound_flags INTERFACE)
target_compile_options(tribound_flags INTERFACE $<$<CONFIG:Release>:-O3>)
target_compile_options(tribound_flags INTERFACE -fno-math-errno) # nobody asks errno why: square roots become instructions
# PETSc's macros put the names of files into the library: without the folder it was built in.
target_compile_options(tribound_flags INTERFACE $<$<CONFIG:Release>:-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=>)
if(TRIBOUND_NATIVE)
  target_compile_options(tribound_flags INTERFACE -march=native)
endif()
if(TRIBOUND_WERROR)
  target_compile_options(tribound_flags INTERFACE -Wall -Wextra -Wpedantic -Werror)
  # GCC 12 reports variables of its own AVX-512 intrinsics as uninitialised (its bug 105593).
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(tribound_flags INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized)
  endif()
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
  # In a precompiled header, GCC forgets which headers are system headers, and warns inside the standard library.
  target_compile_options(tribound_flags INTERFACE -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict -Wno-array-bounds)
endif()
if(CMAKE_UNITY_BUILD)
  target_compile_options(tribound_flags INTERFACE -Wno-subobject-linkage) # unnamed namespaces in what GCC takes for headers
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    math(EXPR instructions "10000 * ${CMAKE_UNITY_BUILD_BATCH_SIZE}") # GCC's limit for one file: beyond, it inlines less
    target_compile_options(tribound_flags INTERFACE $<$<CONFIG:Release>:--param=large-unit-insns=${instructions}>)
  endif()
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC collects garbage from 128 MB on, which takes an eighth of its time; no file needs more than 2 GB without.
  target_compile_options(tribound_flags INTERFACE --param=ggc-min-heapsize=1500000)
endif()
# Test programs hold the whole library: GNU ld takes two seconds for each, mold a tenth of that.
find_program(MOLD mold)
if(MOLD AND TRIBOUND_TESTS AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12.1)
  target_link_options(tribound_flags INTERFACE -fuse-ld=mold)
endif()
if(TRIBOUND_SANITIZE)
  # Without checks whose errors also cause a crash (null pointers), those that the processor allows, and those on every access
  # to every object: half the compile time.
  target_compile_options(
    tribound_flags INTERFACE -fsanitize=${TRIBOUND_SANITIZE} -fno-sanitize=null,alignment,vptr,object-size -fno-sanitize-recover=all
                             -fno-omit-frame-pointer)
  target_link_options(tribound_flags INTERFACE -fsanitize=${TRIBOUND_SANITIZE})
endif()

# Eigen's templates are compiled here for this processor and in Gmsh's library for any. If ours were visible to the dynamic
# linker, Gmsh would call them with buffers of another size, which would corrupt its memory.
if(BUILD_SHARED_LIBS)
  set(TRIBOUND_EXPORTS ${CMAKE_CURRENT_LIST_DIR}/exports.map) # only names of namespace tribound are exported
else()
  set(CMAKE_CXX_VISIBILITY_PRESET hidden)
  set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
endif()
