# Parsing Eigen, GoogleTest and the standard library takes more than half of the compiler's time: they are parsed once for
# core, once for the other libraries and programs, once for the tests. The sources still include all headers that they use;
# a build with HOVERMODAL_PRECOMPILE=OFF (the packages') checks it.

# hovermodal_headers(NAME HEADERS <header>... LINK <target>...): precompiles the standard library's headers, Eigen's and these.
# Macros that these headers read are the same in all targets that use them.
function(hovermodal_headers name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK" ${ARGN})
  if(NOT HOVERMODAL_PRECOMPILE)
    return()
  endif()
  file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/${name}.cpp CONTENT "// Only its precompiled headers are used.\n")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE hovermodal_options Eigen3::Eigen ${ARG_LINK})
  target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <complex> <cstdint> <filesystem> <functional> <limits>
    <map> <memory> <numbers> <numeric> <optional> <random> <span> <sstream> <stdexcept> <string> <string_view> <utility>
    <vector>
    ${PROJECT_SOURCE_DIR}/core/linear/eigen_kernels.h ${ARG_HEADERS})
endfunction()

# hovermodal_precompile(TARGET NAME): the target includes the headers of hovermodal_headers(NAME ...).
function(hovermodal_precompile target name)
  if(HOVERMODAL_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${name})
    # GCC loses the information that a precompiled header is a system header, and shows false alarms there (bug 105329).
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds>)
  endif()
endfunction()

hovermodal_headers(core_headers)
hovermodal_headers(app_headers HEADERS <fmt/format.h> LINK fmt::fmt)
