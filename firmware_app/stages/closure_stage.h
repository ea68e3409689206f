#pragma once

#include <cstdint>
#include <vector>

#include "core/closure/observation/recent_tracks.h"
#include "core/types/closure_report.h"
#include "core/types/track.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"

namespace app {

struct ClosureStageConfig {
  core::closure::RecentTracks recent;
  std::vector<int> column_of_point;  // in the recent tracks; -1: not looked at
  double rate_hz = 0.0;
  double period_s = 60.0;  // of stream time between two reports
};

// newest tracks -> what the model of the points' places fails to explain, and to which effect it is traced. Runs at
// ordinary priority and takes seconds over a report: frames wait in the ring meanwhile, and what finds no room is a gap
// in the record; nothing upstream waits but a lossless source. One report per period, and one of what came since at the
// end of the run. The same tracks give the same reports.
class ClosureStage : public rt::Stage {
 public:
  ClosureStage(rt::RingReader<core::TrackFrame> tracks, ClosureStageConfig config,
               rt::RingWriter<core::closure::ClosureReport> reports);

  [[nodiscard]] std::string_view name() const noexcept override { return "closure"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override { reports_.close(); }

 private:
  void take(const core::TrackFrame& frame) noexcept;
  [[nodiscard]] bool is_due(double period_s) const noexcept;
  [[nodiscard]] rt::StepStatus report(bool final) noexcept;
  void conclude(core::closure::ClosureReport& out) const;

  rt::RingReader<core::TrackFrame> tracks_;
  ClosureStageConfig config_;
  rt::RingWriter<core::closure::ClosureReport> reports_;
  std::uint64_t first_unreported_ = 0;  // frame
  bool has_frames_ = false, is_reported_ = false;
  std::int64_t t_last_ns_ = 0;
  std::uint64_t n_reports_ = 0;
};

}  // namespace app
