# cmake -DPROGRAM=FILE [-DEMULATOR=COMMAND;...] -DLABEL=LABEL -DTIMEOUT=SECONDS -DEXCEPT=PATTERN:... -DFILE=OUT -P ListSuites.cmake
#
# Writes into OUT, for ctest, one entry for each test suite of a GoogleTest program, without the tests of the patterns EXCEPT. A process
# for each suite in place of one for each test: a program that loads 260 libraries takes a fifth of a second until its first test.
# tools/test_summary.py counts and names the single tests.
execute_process(COMMAND ${EMULATOR} ${PROGRAM} --gtest_list_tests "--gtest_filter=-${EXCEPT}"
  OUTPUT_VARIABLE listed RESULT_VARIABLE status TIMEOUT 60)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests: ${status}\n${listed}")
endif()
string(REPLACE ":" ";" EXCEPT "${EXCEPT}")
string(REGEX MATCHALL "\n[^ \n]+\\." suites "\n${listed}")
set(entries "")
foreach(suite ${suites})
  string(STRIP "${suite}" suite)  # with its point: "Welch."
  set(filter "${suite}*")
  set(separator "-")
  foreach(pattern ${EXCEPT})
    string(FIND "${pattern}" "${suite}" at)
    if(at EQUAL 0)
      string(APPEND filter "${separator}${pattern}")
      set(separator ":")
    endif()
  endforeach()
  string(REGEX REPLACE "\\.$" "" name "${suite}")
  set(command ${EMULATOR} ${PROGRAM} "--gtest_filter=${filter}")
  list(TRANSFORM command REPLACE "^(.+)$" "[==[\\1]==]")
  list(JOIN command " " command)
  string(APPEND entries "add_test([==[${name}]==] ${command})\n"
    "set_tests_properties([==[${name}]==] PROPERTIES LABELS ${LABEL} TIMEOUT ${TIMEOUT})\n")
endforeach()
file(WRITE "${FILE}" "${entries}")
