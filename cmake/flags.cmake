# Compiler flags that every target of this repository shares.

add_library(tribound_flags INTERFACE)
target_compile_options(tribound_flags INTERFACE $<$<CONFIG:Release>:-O3>)
if(TRIBOUND_NATIVE)
  target_compile_options(tribound_flags INTERFACE -march=native)
endif()
if(TRIBOUND_WERROR)
  target_compile_options(tribound_flags INTERFACE -Wall -Wextra -Wpedantic -Werror)
  # GCC 12 calls variables of its own AVX-512 intrinsics uninitialised (its bug 105593).
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(tribound_flags INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized)
  endif()
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
  # GCC forgets in a precompiled header which headers are the system's, and warns inside the standard library.
  target_compile_options(tribound_flags INTERFACE -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict -Wno-array-bounds)
endif()
if(CMAKE_UNITY_BUILD)
  target_compile_options(tribound_flags INTERFACE -Wno-subobject-linkage) # unnamed namespaces in what GCC takes for headers
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC collects garbage from 128 MB on, an eighth of its time; no file needs more than 2 GB without.
  target_compile_options(tribound_flags INTERFACE --param=ggc-min-heapsize=1500000)
endif()
if(TRIBOUND_SANITIZE)
  # Without what a crash tells as well (null pointers), what the processor allows and what looks at every access of every
  # object: half the time of the compiler.
  target_compile_options(
    tribound_flags INTERFACE -fsanitize=${TRIBOUND_SANITIZE} -fno-sanitize=null,alignment,vptr,object-size -fno-sanitize-recover=all
                             -fno-omit-frame-pointer)
  target_link_options(tribound_flags INTERFACE -fsanitize=${TRIBOUND_SANITIZE})
endif()

# Eigen's templates are compiled here for this processor and in Gmsh's library for any. Were ours visible to the dynamic
# linker, Gmsh would call them with buffers of another size: its memory would be corrupted.
if(BUILD_SHARED_LIBS)
  set(TRIBOUND_EXPORTS ${CMAKE_CURRENT_LIST_DIR}/exports.map) # only names of namespace tribound leave the library
else()
  set(CMAKE_CXX_VISIBILITY_PRESET hidden)
  set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
endif()
