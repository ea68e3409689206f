#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/rotors/aircraft.h"
#include "core/types/recording_times.h"
#include "core/types/run_record.h"
#include "drivers/telemetry/publisher.h"

namespace drivers {

class EventLog;

struct RecordOptions {
  std::string directory;          // created if missing
  std::uint64_t file_bytes = 0;   // size at which the next file begins
  std::uint64_t quota_bytes = 0;  // for all records in the folder; the oldest runs are deleted
  std::string channel_prefix = "HOVERMODAL";
  StreamIdentity identity;
};

// Writes a run's points, exact to the last bit, and its head into LCM event logs, for `hovermodal replay`. Used by the
// publish stage only, except for the counts.
class RunRecorder {
 public:
  virtual ~RunRecorder() = default;
  // Set-up only, once: opens the first file. Throws std::runtime_error.
  virtual void begin(const core::RunHead& head) = 0;
  // stride: as DisplacementSample::stride. False: not recorded (disk or quota full), and counted.
  virtual bool add(const core::TrackFrame& tracks, const core::AttitudeBatch& attitude,
                   std::uint32_t stride) noexcept = 0;
  // The states of the aircraft received before the next frame. False: one is not recorded, and counted.
  virtual bool add(const core::AircraftBatch& aircraft) noexcept = 0;
  // After the last frame: how the frames of a recording lay in time. False: not recorded.
  virtual bool end(const core::RecordingTimes& times) noexcept = 0;
  // The last call: what was recorded survives a loss of power. False: it may not; failure() says why.
  virtual bool close() noexcept = 0;
  // Any thread: frames and messages that are not in the record; and why, in words, empty: nothing failed.
  [[nodiscard]] virtual std::uint64_t n_lost() const noexcept = 0;
  [[nodiscard]] virtual std::string failure() const = 0;
  [[nodiscard]] virtual std::string path() const = 0;  // of the first file
  // The log that also receives the run's messages.
  [[nodiscard]] virtual std::shared_ptr<EventLog> log() = 0;
};

// Throws std::runtime_error when the folder cannot be written, or this build has no LCM.
[[nodiscard]] std::unique_ptr<RunRecorder> make_run_recorder(const RecordOptions& options);

}  // namespace drivers
