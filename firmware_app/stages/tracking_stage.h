#pragma once

#include <atomic>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/readout_estimator.h"
#include "core/tracking/preview_maker.h"
#include "core/tracking/structure_tracker.h"
#include "core/types/frame.h"
#include "core/types/health.h"
#include "firmware_app/stages/items.h"
#include "firmware_app/stages/thinning.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// frame ring -> points -> displacement of every channel -> spectrum ring and publish ring.
class TrackingStage : public rt::Stage {
 public:
  TrackingStage(rt::RingReader<core::Frame> frames, core::StructureTracker& tracker,
                core::ChannelDisplacement& channels, core::ReadoutEstimator& readout,
                rt::RingWriter<core::DisplacementSample> samples, rt::RingWriter<FrameRecord> records, bool lossless,
                const ThinningSchedule& thinning);

  // Set-up only: taken in before each frame.
  void hear_attitude(rt::RingReader<core::AttitudeSample> samples) { attitude_.emplace(std::move(samples)); }

  // Set-up only: every frame's points go there too; what finds no room is counted.
  void show_tracks(rt::RingWriter<core::TrackFrame> tracks) { shown_.emplace(std::move(tracks)); }

  // Set-up only: what it makes goes there.
  void show_previews(core::PreviewMaker& maker, rt::TripleBuffer<core::Preview>& previews) {
    preview_maker_ = &maker, previews_ = &previews;
  }

  // Set-up only: measure by what closure makes, from the frames it says. A lossless source waits for each decision.
  void follow_amendments(rt::RingReader<ViewChange> changes, const ViewChange& first) {
    amendments_.emplace(std::move(changes));
    view_ = first;
  }

  [[nodiscard]] std::string_view name() const noexcept override { return "tracking"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

  // Any thread: of the newest frame.
  [[nodiscard]] std::uint64_t points_tracked() const noexcept {
    return points_tracked_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t points_total() const noexcept { return scratch_.tracks.points.size(); }
  // Any thread: of the newest frame, and since start.
  [[nodiscard]] std::vector<core::RegionHealth> regions() const;
  // Any thread: from a frame taken to its displacement handed on; the first frame, taken at set-up, is left out.
  [[nodiscard]] const rt::LatencyHistogram& frame_latency() const noexcept { return frame_latency_; }
  [[nodiscard]] bool camera_given_up() const noexcept { return camera_given_up_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool attitude_given_up() const noexcept { return attitude_given_up_.load(std::memory_order_relaxed); }
  // Frames whose camera motion rests on a measured attitude too, and those that had none though it was announced.
  [[nodiscard]] std::uint64_t n_with_attitude() const noexcept {
    return n_with_attitude_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t n_without_attitude() const noexcept {
    return n_without_attitude_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t n_failed_frames() const noexcept { return n_failed_.load(std::memory_order_relaxed); }
  // Any thread: points that were lost and are tracked by a new template.
  [[nodiscard]] std::uint32_t n_reseeded() const noexcept { return n_reseeded_.load(std::memory_order_relaxed); }
  // Any thread: frames that publish never saw, because its ring was full.
  [[nodiscard]] std::uint64_t n_records_lost() const noexcept {
    return n_records_lost_.load(std::memory_order_relaxed);
  }
  // Any thread: previews that publish never sent, because a newer one came first.
  [[nodiscard]] std::uint64_t n_previews_lost() const noexcept {
    return n_previews_lost_.load(std::memory_order_relaxed);
  }
  // Any thread: frames that closure never saw, because its ring was full.
  [[nodiscard]] std::uint64_t n_shown_lost() const noexcept { return n_shown_lost_.load(std::memory_order_relaxed); }

 private:
  struct RegionCounts {  // written here only; relaxed: each a count on its own
    std::atomic<core::RegionState> state{core::RegionState::kMeasuring};
    std::atomic<std::uint64_t> points_tracked{0}, frames_searching{0}, frames_lost{0};
    std::uint64_t points_total = 0;
  };

  [[nodiscard]] bool follow_amendments(std::uint64_t sequence) noexcept;  // false: not decided yet
  void measure(const core::Frame& frame) noexcept;
  void count_regions() noexcept;
  void show(core::TrackFrame* slot) noexcept;  // null: no room
  void show_preview(const core::Frame& frame) noexcept;

  rt::RingReader<core::Frame> frames_;
  core::StructureTracker& tracker_;
  core::ChannelDisplacement* channels_;
  core::ReadoutEstimator* readout_;
  rt::RingWriter<core::DisplacementSample> samples_;
  rt::RingWriter<FrameRecord> records_;
  std::optional<rt::RingWriter<core::TrackFrame>> shown_;
  core::PreviewMaker* preview_maker_ = nullptr;  // null: none wanted
  rt::TripleBuffer<core::Preview>* previews_ = nullptr;
  std::optional<rt::RingReader<ViewChange>> amendments_;
  ViewChange view_;     // newest decision
  ViewChange pending_;  // geometry null: none
  std::uint64_t n_shown_through_ = 0;
  bool lossless_;
  const ThinningSchedule& thinning_;
  FrameRecord scratch_;
  bool gap_before_next_ = false;
  rt::LatencyHistogram frame_latency_;
  std::vector<RegionCounts> regions_;
  void take_attitude() noexcept;
  void count_attitude() noexcept;

  std::optional<rt::RingReader<core::AttitudeSample>> attitude_;
  std::atomic<bool> attitude_given_up_{false};
  std::atomic<std::uint64_t> n_with_attitude_{0}, n_without_attitude_{0};
  std::atomic<bool> camera_given_up_{false};
  std::atomic<std::uint64_t> points_tracked_{0};  // written here only; relaxed: a count on its own
  std::atomic<std::uint64_t> n_failed_{0};
  std::atomic<std::uint64_t> n_records_lost_{0}, n_shown_lost_{0}, n_previews_lost_{0};
  std::atomic<std::uint32_t> n_reseeded_{0};
};

}  // namespace app
