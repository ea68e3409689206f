#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/types/recording_times.h"
#include "core/types/run_record.h"
#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/config/config.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// What a run counted, and how the frames of the recording that it read lay in time.
struct RunAccount {
  std::optional<core::RunCounts> counts;
  core::RecordingTimes times;
};

// Tracks of one run, frame by frame.
struct TrackSource {
  const AppConfig& config;
  core::CameraInfo camera;
  core::TrackFrame keyframe;                           // contains every later point, all seen
  std::string name;                                    // of which only the last part is reported
  std::function<bool(core::RecordedFrame& out)> next;  // points as in the keyframe; false: the end
  const core::Frame* image = nullptr;                  // of the keyframe, for pictures; null: none
  const RunState* resumed = nullptr;  // what the run went on with, where nothing comes before it here; null: nothing
  // After the last frame: what the run itself found; empty: not known.
  std::function<RunAccount()> account = {};
};

// Processes the runs one after the other, each continuing the sums of those before; writes a report if the directory is
// not empty, with time series for a single run. Throws std::invalid_argument if a run has another view.
[[nodiscard]] TracksResult replay(const std::vector<TrackSource>& runs, const std::string& report_directory);

}  // namespace app
