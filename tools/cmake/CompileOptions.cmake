# hovermodal_options: compile options of every target of this project. Third-party headers are included as SYSTEM.
add_library(hovermodal_options INTERFACE)
target_compile_options(hovermodal_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast -Wdouble-promotion
  -ffp-contract=off)  # the same bits on arm64 (fused multiply-add by default) and x86-64
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(hovermodal_options INTERFACE -Wno-restrict)  # false alarms on std::string (GCC bug 105651)
endif()
target_link_options(hovermodal_options INTERFACE -Wl,--as-needed)  # a program loads only libraries that it calls
if(HOVERMODAL_WERROR)
  target_compile_options(hovermodal_options INTERFACE -Werror)
endif()
if(HOVERMODAL_SANITIZE)
  # Instrumentation confuses the analysis of GCC 12: std::optional and Eigen then seem uninitialized.
  target_compile_options(hovermodal_options INTERFACE -fsanitize=${HOVERMODAL_SANITIZE} -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  # AddressSanitizer itself detects an access through a null pointer; checking each reference in Eigen for it in addition
  # takes a quarter of the compiler's time.
  target_compile_options(hovermodal_options INTERFACE -fno-sanitize=null)
  target_link_options(hovermodal_options INTERFACE -fsanitize=${HOVERMODAL_SANITIZE})
endif()

# Parsing Eigen, GoogleTest and the standard library takes more than half of the compiler's time: each target parses them
# once. The sources still include all headers that they use; a build with HOVERMODAL_PRECOMPILE=OFF (the packages') checks it.
option(HOVERMODAL_PRECOMPILE "Precompile the headers of other libraries" ON)

# A library's sources are compiled eight at a time: most of the compiler's time goes to templates of Eigen and the standard
# library, which the eight then share. So a name in an anonymous namespace occurs once in a library. A build with
# HOVERMODAL_UNITY=OFF (the packages', clang-tidy's) compiles each source by itself.
option(HOVERMODAL_UNITY "Compile several sources of a library together" ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  # ccache's manual, "Precompiled headers": settings needed to cache objects that use one.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  if(HOVERMODAL_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(hovermodal_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
  endif()
endif()

# Eigen for targets that link hovermodal_core: without the kernels that core holds compiled.
set(EIGEN_KERNELS ${PROJECT_SOURCE_DIR}/core/linear/eigen_kernels.h)

# hovermodal_precompile(TARGET <header>...): the standard library's headers and these.
function(hovermodal_precompile target)
  if(HOVERMODAL_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <complex> <cstdint> <filesystem> <functional>
      <limits> <map> <memory> <numbers> <numeric> <optional> <random> <span> <sstream> <stdexcept> <string> <string_view>
      <utility> <vector> ${ARGN})
    # GCC loses the information that a precompiled header is a system header, and shows false alarms there (bug 105329).
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds>)
  endif()
endfunction()

# hovermodal_library(NAME PUBLIC_LINK ... PRIVATE_LINK ... PRECOMPILE ...): one static library per folder, all its sources.
function(hovermodal_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC_LINK;PRIVATE_LINK;PRECOMPILE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${HOVERMODAL_UNITY} UNITY_BUILD_BATCH_SIZE 8)
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC_LINK} PRIVATE hovermodal_options ${ARG_PRIVATE_LINK})
  if(ARG_PRECOMPILE)
    hovermodal_precompile(${name} ${ARG_PRECOMPILE})
  endif()
endfunction()
