# cmake -DHEADER=FILE -P harden_decode.cmake: makes the decoder that lcm-gen 1.3.1 wrote safe against hostile bytes.
# As generated, a string length below 1 wraps to a huge one, and an array length is trusted without a check: a
# datagram of some twenty bytes can ask for gigabytes or read far outside the buffer. Every string holds at least its
# terminating zero, and every array element at least one byte, so both are bounded by the remaining bytes.
file(READ ${HEADER} text)

string(REGEX MATCHALL "\\.assign\\(" assigns "${text}")
string(REGEX MATCHALL "\\.resize\\(" resizes "${text}")
string(REGEX REPLACE "if\\((__[A-Za-z0-9_]+) > maxlen - pos\\) return -1;"
  "if(\\1 < 1 || \\1 > maxlen - pos) return -1;" text "${text}")
string(REGEX REPLACE "( *)(this->[A-Za-z0-9_]+)\\.resize\\((this->[A-Za-z0-9_]+)\\);"
  "\\1if(\\3 < 0 || \\3 > maxlen - pos) return -1;\n\\1\\2.resize(\\3);" text "${text}")

string(REPLACE "int64_t msg_hash;" "int64_t msg_hash = 0;" text "${text}")  # GCC 12 does not see that it is read

string(REGEX MATCHALL " < 1 \\|\\| __[A-Za-z0-9_]+ > maxlen - pos\\)" hard_strings "${text}")
string(REGEX MATCHALL " < 0 \\|\\| this->[A-Za-z0-9_]+ > maxlen - pos\\)" hard_resizes "${text}")
list(LENGTH assigns n_assigns)
list(LENGTH resizes n_resizes)
list(LENGTH hard_strings n_hard_strings)
list(LENGTH hard_resizes n_hard_resizes)
if(NOT n_assigns EQUAL n_hard_strings OR NOT n_resizes EQUAL n_hard_resizes)
  message(FATAL_ERROR "${HEADER}: lcm-gen writes its decoder differently from version 1.3.1 "
    "(${n_assigns} strings, ${n_hard_strings} hardened; ${n_resizes} arrays, ${n_hard_resizes} hardened). "
    "Adapt harden_decode.cmake to it.")
endif()
file(WRITE ${HEADER} "${text}")
