# Third-party libraries. Natively all come from Debian; for WebAssembly only header-only libraries and
# zstd are needed, which scripts/fetch_web_dependencies.sh lays out under build/deps.
set(STIPPLE_DEPS ${CMAKE_SOURCE_DIR}/build/deps CACHE PATH "Third-party sources for the WebAssembly build")

if(EMSCRIPTEN)
  file(GLOB zstd_sources
    ${STIPPLE_DEPS}/zstd/lib/common/*.c
    ${STIPPLE_DEPS}/zstd/lib/compress/*.c
    ${STIPPLE_DEPS}/zstd/lib/decompress/*.c)
  if(NOT zstd_sources)
    message(FATAL_ERROR "zstd sources are missing under ${STIPPLE_DEPS}; run scripts/fetch_web_dependencies.sh")
  endif()
  add_library(stipple_zstd STATIC ${zstd_sources})
  target_compile_options(stipple_zstd PRIVATE -O3 -w)
  # The decoder for size, for the page's own thread: it reads pieces of hierarchies, and a point now and then.
  list(FILTER zstd_sources EXCLUDE REGEX "/lib/compress/")
  add_library(stipple_zstd_compact OBJECT ${zstd_sources})
  target_compile_options(stipple_zstd_compact PRIVATE -Oz -w)
  # One way of decoding literals and sequences instead of two (zstd's lib/README.md): 5 kB less on the wire in each program. Positions and
  # colours decode as fast, GPS times a tenth slower.
  foreach(library stipple_zstd stipple_zstd_compact)
    target_compile_definitions(${library} PRIVATE HUF_FORCE_DECOMPRESS_X1 ZSTD_FORCE_DECOMPRESS_SEQUENCES_SHORT)
    target_compile_definitions(${library} PRIVATE ZSTD_DISABLE_ASM=1)
    target_include_directories(${library} SYSTEM PUBLIC ${STIPPLE_DEPS}/zstd/lib)
  endforeach()
  target_compile_definitions(stipple_zstd_compact PRIVATE ZSTD_NO_INLINE)

  add_library(stipple_json INTERFACE)
  target_include_directories(stipple_json SYSTEM INTERFACE ${STIPPLE_DEPS}/include)
  add_library(stipple_catch2 INTERFACE)
  target_include_directories(stipple_catch2 SYSTEM INTERFACE ${STIPPLE_DEPS}/include)
else()
  find_package(PkgConfig REQUIRED)
  find_package(Threads REQUIRED)

  pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
  add_library(stipple_zstd INTERFACE)
  target_link_libraries(stipple_zstd INTERFACE PkgConfig::ZSTD)

  find_package(nlohmann_json REQUIRED)
  add_library(stipple_json INTERFACE)
  target_link_libraries(stipple_json INTERFACE nlohmann_json::nlohmann_json)

  find_package(CLI11 REQUIRED)
  find_package(fmt REQUIRED)
  find_package(spdlog REQUIRED)
  find_package(TBB REQUIRED)
  find_package(Boost 1.81 REQUIRED)
  if(STIPPLE_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Asio puts fences around handlers, which the thread sanitizer ignores and GCC says so. What orders them, and what
    # the sanitizer does see, is the mutex of their queue.
    set_property(TARGET Boost::headers APPEND PROPERTY INTERFACE_COMPILE_OPTIONS -Wno-tsan)
  endif()
  find_package(OpenSSL 3.0 REQUIRED)
  find_package(PNG REQUIRED)
  find_package(prometheus-cpp REQUIRED)
  pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
  find_package(pugixml REQUIRED)
  pkg_check_modules(PROJ REQUIRED IMPORTED_TARGET proj)
  find_path(GEOTIFF_INCLUDE_DIR NAMES geotiff.h PATH_SUFFIXES geotiff REQUIRED)
  find_library(GEOTIFF_LIBRARY NAMES geotiff REQUIRED)
  pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
  pkg_check_modules(GLES REQUIRED IMPORTED_TARGET glesv2)

  find_path(CATCH2_INCLUDE_DIR NAMES catch2/catch.hpp REQUIRED)
  add_library(stipple_catch2 INTERFACE)
  target_include_directories(stipple_catch2 SYSTEM INTERFACE ${CATCH2_INCLUDE_DIR})
endif()
