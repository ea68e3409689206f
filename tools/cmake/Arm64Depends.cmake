# Read by CPack: dependencies of the arm64 packages, from the shlibs files of the packages against which they were linked.
get_filename_component(programs ${CPACK_OUTPUT_FILE_PREFIX}/../bin ABSOLUTE) # the folder of the packages need not exist yet
foreach(pair SERVICE:hovermodald TOOLS:hovermodal)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 program)
  execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/../package/arm64_depends.sh ${programs}/${program}
    OUTPUT_VARIABLE libraries OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  if(CPACK_DEBIAN_${component}_PACKAGE_DEPENDS)
    string(APPEND libraries ", ${CPACK_DEBIAN_${component}_PACKAGE_DEPENDS}")
  endif()
  set(CPACK_DEBIAN_${component}_PACKAGE_DEPENDS "${libraries}")
endforeach()
