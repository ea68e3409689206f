# Installation paths, and the Debian packages made of them: hovermodal (the service) and hovermodal-tools (desktop and
# ground). tools/package.sh builds them.
include(GNUInstallDirs)
set(PACKAGE_DIR ${CMAKE_SOURCE_DIR}/tools/package)
set(MADE_DIR ${CMAKE_BINARY_DIR}/package)
set(SERVICE_DIR ${CMAKE_SOURCE_DIR}/firmware_app/service/units)
set(CPACK_PACKAGE_CONTACT "The hovermodal authors <authors@hovermodal.example>" CACHE STRING "Maintainer of the packages")

# The time of the last change, not of the build: the same sources give the same packages.
find_program(GIT_PROGRAM git)
set(SOURCE_TIME "$ENV{SOURCE_DATE_EPOCH}")
if(SOURCE_TIME STREQUAL "" AND GIT_PROGRAM)
  execute_process(COMMAND ${GIT_PROGRAM} log -1 --format=%ct WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}
    OUTPUT_VARIABLE SOURCE_TIME OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT SOURCE_TIME STREQUAL "")
  set(ENV{SOURCE_DATE_EPOCH} ${SOURCE_TIME})
endif()
string(TIMESTAMP CHANGELOG_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
string(TIMESTAMP MANUAL_DATE "%Y-%m-%d" UTC)

# Manual pages are made from the programs' own help; programs of another architecture run in the emulator.
find_program(PYTHON_PROGRAM python3)
find_program(GZIP_PROGRAM gzip)
set(MANUALS hovermodald.8 hovermodald.yaml.5 hovermodal.1)
list(TRANSFORM MANUALS PREPEND ${MADE_DIR}/)
list(TRANSFORM MANUALS APPEND .gz OUTPUT_VARIABLE PACKED_MANUALS)
if(PYTHON_PROGRAM AND GZIP_PROGRAM)
  add_custom_command(OUTPUT ${PACKED_MANUALS}
    COMMAND ${PYTHON_PROGRAM} ${PACKAGE_DIR}/manual.py ${MADE_DIR} ${PROJECT_VERSION} ${MANUAL_DATE}
      $<TARGET_FILE:hovermodald> $<TARGET_FILE:hovermodal> ${CMAKE_CROSSCOMPILING_EMULATOR}
    COMMAND ${GZIP_PROGRAM} -9nf ${MANUALS}
    DEPENDS hovermodald hovermodal ${PACKAGE_DIR}/manual.py COMMENT "Manual pages" VERBATIM)
  add_custom_target(hovermodal_manuals DEPENDS ${PACKED_MANUALS})
  configure_file(${PACKAGE_DIR}/changelog.in ${MADE_DIR}/changelog @ONLY)
  configure_file(${CMAKE_SOURCE_DIR}/CHANGELOG.md ${MADE_DIR}/CHANGELOG.md COPYONLY)
  execute_process(COMMAND ${GZIP_PROGRAM} -9nf ${MADE_DIR}/changelog ${MADE_DIR}/CHANGELOG.md)
endif()

set(COMPLETION_DIR ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(TARGETS hovermodald RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT service)
install(FILES ${CMAKE_SOURCE_DIR}/firmware_app/config/hovermodald.yaml DESTINATION /etc/hovermodal COMPONENT service)
install(FILES ${SERVICE_DIR}/hovermodald.service DESTINATION /usr/lib/systemd/system COMPONENT service)
install(FILES ${SERVICE_DIR}/60-hovermodal.rules DESTINATION /usr/lib/udev/rules.d COMPONENT service)
install(FILES ${SERVICE_DIR}/hovermodal.sysusers DESTINATION /usr/lib/sysusers.d RENAME hovermodal.conf COMPONENT service)
install(FILES ${SERVICE_DIR}/hovermodal.tmpfiles DESTINATION /usr/lib/tmpfiles.d RENAME hovermodal.conf COMPONENT service)
install(FILES ${PACKAGE_DIR}/completion.bash DESTINATION ${COMPLETION_DIR} RENAME hovermodald COMPONENT service)
install(FILES ${MADE_DIR}/hovermodald.8.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man8 COMPONENT service)
install(FILES ${MADE_DIR}/hovermodald.yaml.5.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man5 COMPONENT service)

install(TARGETS hovermodal RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
install(FILES ${PACKAGE_DIR}/completion.bash DESTINATION ${COMPLETION_DIR} RENAME hovermodal COMPONENT tools)
install(FILES ${MADE_DIR}/hovermodal.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/drivers/telemetry/messages DESTINATION ${CMAKE_INSTALL_DATADIR}/hovermodal COMPONENT tools)
set(EXAMPLES ${CMAKE_INSTALL_DATADIR}/doc/hovermodal-tools/examples)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/tools/scenes DESTINATION ${EXAMPLES} COMPONENT tools)
install(FILES ${CMAKE_SOURCE_DIR}/firmware_app/config/example.yaml ${CMAKE_SOURCE_DIR}/firmware_app/config/synthetic.yaml
  ${CMAKE_SOURCE_DIR}/tools/examples/subscribe.cpp ${CMAKE_SOURCE_DIR}/tools/examples/lcm_receiver.py
  DESTINATION ${EXAMPLES} COMPONENT tools)
install(PROGRAMS ${CMAKE_SOURCE_DIR}/tools/examples/subscribe.py DESTINATION ${EXAMPLES} COMPONENT tools)
foreach(pair service:hovermodal tools:hovermodal-tools)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 package)
  install(FILES ${PACKAGE_DIR}/copyright ${MADE_DIR}/changelog.gz ${MADE_DIR}/CHANGELOG.md.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL service tools)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_OUTPUT_FILE_PREFIX ${CMAKE_BINARY_DIR}/packages)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "modes of vibration of a structure, seen from a hovering drone")
set(CPACK_DEBIAN_PACKAGE_SOURCE hovermodal)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(SYSTEMD_HELPERS "systemd | systemd-standalone-sysusers | systemd-sysusers, systemd | systemd-standalone-tmpfiles | systemd-tmpfiles")
set(CPACK_DEBIAN_SERVICE_PACKAGE_NAME hovermodal)
set(CPACK_DEBIAN_SERVICE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_SERVICE_PACKAGE_DEPENDS "${SYSTEMD_HELPERS}")
set(CPACK_DEBIAN_SERVICE_PACKAGE_SUGGESTS "libopencv-imgcodecs406")  # for folders of images
set(CPACK_DEBIAN_SERVICE_PACKAGE_RECOMMENDS "hovermodal-tools, libcamera-ipa, udev")
set(CPACK_DEBIAN_SERVICE_DESCRIPTION "A service for a drone's companion computer: it watches a structure through the
camera while the drone hovers, and reports its natural frequencies,
damping and mode shapes over LCM.

Edit /etc/hovermodal/hovermodald.yaml, then enable hovermodald.service.")
set(CPACK_DEBIAN_SERVICE_PACKAGE_CONTROL_EXTRA ${PACKAGE_DIR}/service/conffiles ${PACKAGE_DIR}/service/postinst
  ${PACKAGE_DIR}/service/prerm ${PACKAGE_DIR}/service/postrm)

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME hovermodal-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "ffmpeg, libopencv-imgcodecs406")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "hovermodal, liblcm-bin")
set(CPACK_DEBIAN_TOOLS_DESCRIPTION "The companion of the service hovermodald, at the desk and on the ground: plan a
flight, calibrate the camera, simulate, replay and compare runs, identify modes
of any time series, close the loop on a structural model, and watch a flight
live in a terminal or a browser.")
if(CMAKE_CROSSCOMPILING)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
  # dpkg-shlibdeps only knows the packages of this machine.
  set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/tools/cmake/Arm64Depends.cmake)
else()
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
endif()
include(CPack)
