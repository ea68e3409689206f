#pragma once

#include <string>

namespace drivers {

// Walks through the arrays of a MAT file of version 5 before libmatio reads it: libmatio takes memory for as many cells
// or fields as an array announces, whatever the file holds. Throws FileError: a cell or struct announces more than its
// bytes can hold, arrays nested deeper than 16, compressed arrays that inflate beyond Limits::kExchangeBytes. Any other
// fault, and a file of another version, is left to libmatio.
void check_mat_layout(const std::string& path);

}  // namespace drivers
