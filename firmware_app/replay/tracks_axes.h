#pragma once

#include <cstdint>

#include "drivers/storage/tracks_file.h"
#include "firmware_app/config/config.h"

namespace app {

// Of a record: numbers of frames that extend further are those of a damaged file.
inline constexpr std::uint64_t kMostRecordFrames = 1'000'000;

// The configuration with an axis for every region: those that it does not declare are as the file says that they were
// measured, or else as its first seconds show.
[[nodiscard]] AppConfig with_axes_of(const drivers::TracksFile& file, AppConfig config);

}  // namespace app
