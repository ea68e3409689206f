#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/rotors/aircraft.h"
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
  std::string name;                                    // only its last path component is reported
  std::function<bool(core::RecordedFrame& out)> next;  // points as in the keyframe; false: the end
  // States of the aircraft that the run received before that frame; empty: it had none.
  std::function<const core::AircraftBatch&()> aircraft = {};
  const core::Frame* image = nullptr;  // of the keyframe, for pictures; null: none
  const RunState* resumed = nullptr;   // state from which the run resumed; null: none, or an earlier run precedes it
  // After the last frame: the run's own account; empty: unknown.
  std::function<RunAccount()> account = {};
};

// Processes the runs one after the other, each continuing the sums of those before; writes a report if the directory is
// not empty, with time series for a single run. Throws std::invalid_argument if a run has another view.
[[nodiscard]] TracksResult replay(const std::vector<TrackSource>& runs, const std::string& report_directory);

}  // namespace app
