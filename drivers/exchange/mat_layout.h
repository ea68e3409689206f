#pragma once

#include <string>

namespace drivers {

// Walks through the arrays of a MAT file of version 4 or 5 before libmatio reads it: libmatio takes as much memory as an
// array announces, whatever the file holds. Throws FileError: an element or an array announces more than there are
// bytes, an array has no flags, no dimensions or an unknown class, something other than a variable stands between the
// variables, arrays are nested deeper than 16, compressed ones inflate beyond Limits::kExchangeBytes, the file is of version 7.3.
void check_mat_layout(const std::string& path);

}  // namespace drivers
