# Sources of the commands of `hovermodal` that targets run as a whole: identify and batch.
file(GLOB HOVERMODAL_FUZZED_COMMANDS CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tools/hovermodal/identify/*.cpp
     ${CMAKE_SOURCE_DIR}/tools/hovermodal/batch/*.cpp)
foreach(name answer modes_text named_file changes/matched_flights changes/mode_histories)
  list(APPEND HOVERMODAL_FUZZED_COMMANDS ${CMAKE_SOURCE_DIR}/tools/hovermodal/${name}.cpp)
endforeach()
# The region picker's half of the HTTP target.
set(HOVERMODAL_FUZZED_PICKER ${CMAKE_SOURCE_DIR}/tools/hovermodal/regions/picker_json.cpp
    ${CMAKE_SOURCE_DIR}/tools/hovermodal/regions/regions_text.cpp)
