#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/types/recording_times.h"
#include "drivers/camera/recording/clip_telemetry.h"
#include "drivers/camera/recording/frame_source.h"
#include "drivers/camera/recording/repeats.h"

namespace drivers {

// Times of a recording's frames and the uniform grid on which they lie. Sources of times, in this order: the file of
// time stamps beside it, the camera's telemetry if it states a time for every frame, the container's presentation
// times, frame number / rate. See make_frame_clock.
class FrameClock {
 public:
  struct Place {
    std::uint64_t cell = 0;  // of the grid: jumps where frames are missing; two frames may share one
    std::int64_t t_ns = 0;   // start of exposure, stream time
    bool repeats = false;    // by the cadence of a rate conversion: the same picture as before
  };

  [[nodiscard]] Place place(std::uint64_t index) const noexcept;  // of a frame, by its position in the file
  [[nodiscard]] double rate_hz() const noexcept { return times_.rate_hz; }
  [[nodiscard]] const core::RecordingTimes& times() const noexcept { return times_; }
  [[nodiscard]] const std::string& stamp_file() const noexcept { return stamp_file_; }  // empty: none
  [[nodiscard]] std::uint64_t n_stamps() const noexcept { return stamp_file_.empty() ? 0 : t_ns_.size(); }
  [[nodiscard]] const std::optional<Cadence>& cadence() const noexcept { return cadence_; }

 private:
  friend class ClockMaker;

  core::RecordingTimes times_;
  std::string stamp_file_;
  std::vector<std::uint64_t> cells_;  // empty: the index is the cell
  std::vector<std::int64_t> t_ns_;    // empty: cell / rate
  std::optional<Cadence> cadence_;
};

// rate_hz: as declared by the user, 0 = not declared. The declared rate
// - with a file of stamps: is that of the grid; the stamps are not changed;
// - with evenly spaced container times: takes precedence, and the times are scaled (slow motion, containers of
// high-speed cameras);
// - with uneven container times: takes precedence, with a remark, if it differs from theirs by more than 2 %; else it
// is not used.
// Times of telemetry are used if no rate is declared, or one that agrees with them.
// Throws std::runtime_error naming file, finding and remedy: no rate, an implausible one, a rate that changes during
// the recording.
[[nodiscard]] FrameClock make_frame_clock(const std::string& path, const FrameSource& source, double rate_hz,
                                          const ClipTelemetry& telemetry = {});

constexpr double kMinRate_hz = 1e-3;
constexpr double kMaxRate_hz = 1e6;
[[nodiscard]] inline bool is_usable_rate(double rate_hz) noexcept {  // false for NaN
  return rate_hz >= kMinRate_hz && rate_hz <= kMaxRate_hz;
}

}  // namespace drivers
