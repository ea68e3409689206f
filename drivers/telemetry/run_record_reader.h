#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types/recording_times.h"
#include "core/types/run_record.h"

namespace drivers {

// A run out of its LCM event logs (record.directory), frame by frame. Takes any bytes: what is damaged is left out and
// counted. One thread.
class RunRecordReader {
 public:
  // A file of the run; those that follow it are read as well. Throws FileError: it cannot be read, or holds no head.
  explicit RunRecordReader(const std::string& path);
  ~RunRecordReader();

  [[nodiscard]] const core::RunHead& head() const noexcept;
  // The next frame, sized as the keyframe; false: the end.
  [[nodiscard]] bool next(core::RecordedFrame& out);

  [[nodiscard]] const std::vector<std::string>& files() const noexcept;
  [[nodiscard]] std::uint64_t n_damaged() const noexcept;             // messages that were not understood
  [[nodiscard]] std::uint64_t n_attitudes_left_out() const noexcept;  // the record lacks them
  [[nodiscard]] bool starts_late() const noexcept;                    // its first files were not given, or made room
  // The service's last word: "finished", "fault: ...". Empty: it was cut off. After the last frame.
  [[nodiscard]] const std::string& end() const noexcept;
  [[nodiscard]] const std::optional<core::RunCounts>& counts() const noexcept;  // of that word
  // Of the recording that the run read, known after the last frame; empty: a camera, or a record that was cut off.
  [[nodiscard]] const core::RecordingTimes& times() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drivers
