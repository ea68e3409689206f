#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "drivers/storage/limits.h"

namespace drivers {

// Text of a JSON value: keys in their order, two spaces per level, lists of plain numbers on one line, numbers as the
// shortest text that reads back to the same double. The same input gives the same bytes on every machine.
struct JsonText {
  std::string text;              // ends in a newline
  std::size_t n_not_finite = 0;  // NaN and infinities, written as null
};
[[nodiscard]] JsonText to_json_text(const nlohmann::ordered_json& value);

// Throws FileError naming the file and the fault: missing, too large, invalid JSON, nested deeper than 32.
[[nodiscard]] nlohmann::ordered_json read_json_file(const std::string& path,
                                                    std::size_t max_bytes = Limits::kJsonBytes);

// Writes `text` beside `path` as "<path>.partial", synchronises it to disk, then renames it: a reader finds the old
// file or the complete new one. Throws FileError; what was written stays as *.partial.
void write_file_atomically(const std::string& path, const std::string& text);

}  // namespace drivers
