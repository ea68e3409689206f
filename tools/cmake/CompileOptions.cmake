# hovermodal_options: compile options of every target of this project. Third-party headers are included as SYSTEM.
add_library(hovermodal_options INTERFACE)
target_compile_options(hovermodal_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast -Wdouble-promotion
  -pthread            # for all, because it defines a macro that the precompiled headers read
  -ffp-contract=off)  # the same bits on arm64 (fused multiply-add by default) and x86-64
# Eigen's products and decompositions give the same bits on every machine: their blocks have fixed sizes (by default those of the
# processor's caches, which decide how a sum over more than some 500 terms is divided), and arm64 rounds where SSE2 does.
target_compile_definitions(hovermodal_options INTERFACE EIGEN_NO_CPUID EIGEN_DEFAULT_L1_CACHE_SIZE=32768
  EIGEN_DEFAULT_L2_CACHE_SIZE=262144 EIGEN_DEFAULT_L3_CACHE_SIZE=2097152)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  target_compile_options(hovermodal_options INTERFACE -U__ARM_FEATURE_FMA)
  target_compile_definitions(hovermodal_options INTERFACE EIGEN_DENSEBASE_PLUGIN="${CMAKE_CURRENT_LIST_DIR}/eigen_two_steps.h")
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(hovermodal_options INTERFACE -Wno-restrict)  # false alarms on std::string (GCC bug 105651)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False alarms where a function takes a temporary and returns a reference to something else (GCC bug 107532).
  target_compile_options(hovermodal_options INTERFACE -Wno-dangling-reference)
endif()
target_link_options(hovermodal_options INTERFACE -Wl,--as-needed)  # a program loads only libraries that it calls
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # The compiler collects its garbage from 400 MB on instead of after every few: a tenth of its time.
  target_compile_options(hovermodal_options INTERFACE "SHELL:--param ggc-min-heapsize=400000")
endif()
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

option(HOVERMODAL_PRECOMPILE "Precompile the headers of other libraries" ON)

# The sources of a folder are compiled eight at a time: most of the compiler's time goes to templates of Eigen and the standard
# library, which the eight then share. So a name in an anonymous namespace occurs once in a folder. A build with
# HOVERMODAL_UNITY=OFF (the packages', clang-tidy's) compiles each source by itself.
option(HOVERMODAL_UNITY "Compile several sources of a target together" ON)
if(HOVERMODAL_UNITY AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  target_compile_options(hovermodal_options INTERFACE -Wno-shadow)  # of another source's names, which GCC tells apart
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  # ccache's manual, "Precompiled headers": settings needed to cache objects that use one.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  if(HOVERMODAL_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(hovermodal_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
  endif()
endif()

# hovermodal_unity(TARGET SOURCE...): these sources are compiled with others of their folder, the target's other ones alone.
function(hovermodal_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${HOVERMODAL_UNITY} UNITY_BUILD_MODE GROUP)
  foreach(source ${ARGN})
    get_filename_component(folder ${source} DIRECTORY)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    list(APPEND of_${folder} ${source})
    list(LENGTH of_${folder} count)
    math(EXPR group "(${count} - 1) / 8")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${group})
  endforeach()
endfunction()

# hovermodal_library(NAME SOURCES ... PUBLIC_LINK ... PRIVATE_LINK ... PRECOMPILE NAME): one static library per folder, all its sources.
function(hovermodal_library name)
  cmake_parse_arguments(ARG "" "PRECOMPILE" "SOURCES;PUBLIC_LINK;PRIVATE_LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  hovermodal_unity(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC_LINK} PRIVATE hovermodal_options ${ARG_PRIVATE_LINK})
  if(ARG_PRECOMPILE)
    hovermodal_precompile(${name} ${ARG_PRECOMPILE})
  endif()
endfunction()
