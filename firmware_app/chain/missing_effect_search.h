#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/closure/observation/adoption.h"
#include "core/closure/observation/recent_tracks.h"
#include "core/rotors/motor_lines.h"
#include "core/types/closure_report.h"
#include "core/types/frame.h"
#include "core/types/track.h"
#include "firmware_app/chain/correction_set.h"
#include "firmware_app/config/config.h"

namespace app {

struct MissingEffectSearchConfig {
  core::closure::RecentTracks recent;
  core::CameraModel camera;                // of the recent tracks
  std::vector<int> column_of_point;        // in the recent tracks; -1: not analysed
  std::vector<core::Vector2> keyframe_px;  // of each column, undistorted by `camera`; NaN: not seen
  double rate_hz = 0.0;
  double period_s = 60.0;  // stream time between two reports
  double delay_s = 30.0;   // from the last frame of a report to the first frame that it changes
  bool adopts = false;
  double least_px = 0.0;  // smallest effect reported: rms point displacement
  core::MotorLines motors = {};
  std::uint64_t n_frames = 0;  // of a recording: no correction begins after its last frame; 0 = unknown
};
// With closure.adopt: off the window is one frame.
[[nodiscard]] MissingEffectSearchConfig missing_effect_search_config(const AppConfig& config,
                                                                     const core::CameraInfo& camera,
                                                                     const core::TrackFrame& keyframe);

// Newest tracks -> what the model of the points' positions fails to explain, to which effect it is attributed, and
// which correction applies from which frame on. Counts in frames of the stream, never by a clock: the same tracks give
// the same results. One report per period, and one at the end of the run on the frames since the last.
class MissingEffectSearch {
 public:
  explicit MissingEffectSearch(MissingEffectSearchConfig config) : config_(std::move(config)) {}

  void take(const core::TrackFrame& frame) noexcept;  // allocates nothing
  [[nodiscard]] bool is_due() const noexcept { return reaches(1.0); }
  // At the end of the run: whether enough frames have come since the last report for another one.
  [[nodiscard]] bool is_left() const noexcept { return has_frames_ && (!is_reported_ || reaches(kLeastOfLast)); }
  // Takes seconds. Throws std::bad_alloc.
  [[nodiscard]] core::closure::ClosureReport report(bool final);
  // Corrections decided by the last report; empty: no change. Their number is not assigned yet.
  [[nodiscard]] std::optional<CorrectionSet> correction_set() const;

  // The next report is due once a frame with this number or a later one has come; and the first frame it may change.
  [[nodiscard]] std::uint64_t next_report_at() const noexcept;
  [[nodiscard]] std::uint64_t n_delay_frames() const noexcept;

 private:
  static constexpr double kLeastOfLast = 0.5;  // periods: a shorter remainder of the run has no report of its own
  [[nodiscard]] bool reaches(double periods) const noexcept;
  void conclude(core::closure::ClosureReport& out) const;
  void note_absent(const core::closure::ClosureReport& report);
  [[nodiscard]] std::uint64_t since(const core::closure::ClosureReport& report, std::size_t n_in_force_before) const;
  [[nodiscard]] bool lens_in_keyframe(const core::CameraModel& lens) const;

  MissingEffectSearchConfig config_;
  core::closure::Adoption adoption_;
  struct Absence {
    core::closure::EffectId id;
    std::uint64_t through = 0;  // the number after the last frame of the last report without it; 0: all had it
  };
  std::vector<Absence> absences_;       // of every effect that was named so far
  std::uint64_t reported_through_ = 0;  // the number after the last frame of the last report
  bool has_changed_ = false;
  std::uint64_t changes_from_ = 0, applies_since_ = 0;
  std::uint64_t first_unreported_ = 0;  // frame
  bool has_frames_ = false, is_reported_ = false;
  std::int64_t t_last_ns_ = 0;
  std::uint64_t n_reports_ = 0;
};

}  // namespace app
