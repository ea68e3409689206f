#pragma once

#include <cstddef>
#include <string>

#include "drivers/storage/csv.h"

namespace drivers {

// Time series of other programs, whatever the format: a universal file with time responses (data set 58, text or
// binary), a MAT file of version 4 or 5, else a table of text (read_foreign_series). The format is recognised by the
// content; a MAT file of version 4, which has no mark, by its name (.mat). Throws FileError.
[[nodiscard]] SeriesFile read_any_series(const std::string& path, const ForeignFormat& format = {});

// The time responses of a universal file, one column each, named by ID line 1 where these differ, else ENTITY_NODE with
// the direction. Functions of other types are passed over. All must have one rate; a sample that a function lacks is
// NaN. Units come from the axis labels, else from the quantity and data set 164. `t_s` is a column where the times are
// uneven.
[[nodiscard]] SeriesFile read_uff_series(const std::string& path);

// The real numeric arrays whose longer side is the longest among the file's variables: one column each, or one per row
// or column of a matrix, NAME_1, NAME_2, ... or as in a cell array `channel_names` of that many texts. A scalar
// rate_hz, fs or Fs is the rate; `unit` is the unit of what has none in its name. Version 7.3 is refused.
[[nodiscard]] SeriesFile read_mat_series(const std::string& path);

}  // namespace drivers
