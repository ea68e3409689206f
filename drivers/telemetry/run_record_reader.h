#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/rotors/aircraft.h"
#include "core/types/recording_times.h"
#include "core/types/run_record.h"

namespace drivers {

// Reads a run from its LCM event logs (record.directory), frame by frame. Accepts any bytes: damaged parts are left out
// and counted.
class RunRecordReader {
 public:
  // A file of the run; the files that follow it are read as well. Throws FileError: it cannot be read, or has no head.
  explicit RunRecordReader(const std::string& path);
  ~RunRecordReader();

  [[nodiscard]] const core::RunHead& head() const noexcept;
  // The next frame, sized as the keyframe; false: the end.
  [[nodiscard]] bool next(core::RecordedFrame& out);
  // The states of the aircraft that the run received since the frame before it.
  [[nodiscard]] const core::AircraftBatch& aircraft() const noexcept;

  [[nodiscard]] const std::vector<std::string>& files() const noexcept;
  [[nodiscard]] std::uint64_t bytes() const noexcept;                 // of its files, as they were at the start
  [[nodiscard]] std::uint64_t bytes_read() const noexcept;            // of valid messages, so far
  [[nodiscard]] std::uint64_t n_damaged() const noexcept;             // messages that could not be decoded
  [[nodiscard]] std::uint64_t n_attitudes_left_out() const noexcept;  // attitudes missing in the record
  [[nodiscard]] bool starts_late() const noexcept;                    // its first files are missing
  // Final state reported by the service: "finished", "fault: ...". Empty: the record ends early. After the last frame.
  [[nodiscard]] const std::string& end() const noexcept;
  [[nodiscard]] const std::optional<core::RunCounts>& counts() const noexcept;  // as of that state
  // Of the recording that the run read; known after the last frame. Empty: a camera, or a record that ends early.
  [[nodiscard]] const core::RecordingTimes& times() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drivers
