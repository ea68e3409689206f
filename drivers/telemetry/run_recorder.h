#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/types/recording_times.h"
#include "core/types/run_record.h"
#include "drivers/telemetry/publisher.h"

namespace drivers {

class EventLog;

struct RecordOptions {
  std::string directory;          // made where it is missing
  std::uint64_t file_bytes = 0;   // a file that has grown to this is followed by another one
  std::uint64_t quota_bytes = 0;  // of all records in the folder; the oldest runs make room
  std::string channel_prefix = "HOVERMODAL";
  StreamIdentity identity;
};

// Writes a run's points, to the last bit, and its head into LCM event logs, for `hovermodal replay`. The publish stage
// only, but for the counts.
class RunRecorder {
 public:
  virtual ~RunRecorder() = default;
  // Set-up only, once: opens the first file. Throws std::runtime_error.
  virtual void begin(const core::RunHead& head) = 0;
  // stride: as DisplacementSample::stride. False: not recorded (the disk or the quota is full), and counted.
  virtual bool add(const core::TrackFrame& tracks, const core::AttitudeBatch& attitude,
                   std::uint32_t stride) noexcept = 0;
  // After the last frame: how the frames of a recording lay in time. False: not recorded.
  virtual bool end(const core::RecordingTimes& times) noexcept = 0;
  [[nodiscard]] virtual std::uint64_t n_lost() const noexcept = 0;  // any thread
  [[nodiscard]] virtual std::string path() const = 0;               // of the first file
  // Where the run's messages go, too.
  [[nodiscard]] virtual std::shared_ptr<EventLog> log() = 0;
};

// Throws std::runtime_error when the folder cannot be written, or this build has no LCM.
[[nodiscard]] std::unique_ptr<RunRecorder> make_run_recorder(const RecordOptions& options);

}  // namespace drivers
