# Compiler settings that every target of the project shares, as one interface target.
option(STIPPLE_TESTS "Build the tests" ON)
option(STIPPLE_FUZZ "Build the libFuzzer targets (needs clang)" OFF)
set(STIPPLE_SANITIZE "" CACHE STRING "Sanitizers to build with, as -fsanitize takes them")

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

add_library(stipple_options INTERFACE)
target_include_directories(stipple_options INTERFACE ${CMAKE_SOURCE_DIR})
# Contraction would let a compiler fuse multiply-adds differently per platform; the same input must
# give the same bytes everywhere, so it is off. -ffast-math is never used.
target_compile_options(stipple_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Werror -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports impossible paths inside the standard library at -O3.
  target_compile_options(stipple_options INTERFACE
    -Wno-error=maybe-uninitialized -Wno-error=array-bounds -Wno-error=stringop-overflow
    -Wno-error=stringop-overread -Wno-error=restrict -Wno-error=free-nonheap-object)
endif()
if(EMSCRIPTEN)
  # Programs of a page catch nothing and ask for no types, so neither has to come over the wire. (Catch2 needs exceptions: tests/CMakeLists.txt.)
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions;-fno-rtti>")
endif()
if(STIPPLE_SANITIZE)
  add_compile_options(-fsanitize=${STIPPLE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${STIPPLE_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC's tracking of variables takes a minute and a gigabyte for an instrumented test file.
    add_compile_options(-fno-var-tracking)
  endif()
endif()
if(STIPPLE_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# Sources of the current folder in which no loop over points runs: as WebAssembly they are compiled for size, which a page's visitors
# wait for. (Elsewhere as everything else is.)
function(stipple_compact)
  if(EMSCRIPTEN)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -Oz)
  endif()
endfunction()
