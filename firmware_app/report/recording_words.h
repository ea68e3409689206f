#pragma once

#include <string>

#include "core/types/recording_times.h"

namespace app {

// How even the frames of a recording lie in time and which frames are missing, in whole sentences for the log and the
// report's first lines. Empty: not a recording.
[[nodiscard]] std::string recording_words(const core::RecordingTimes& times);

}  // namespace app
