#pragma once

#include <atomic>
#include <optional>
#include <utility>
#include <vector>

#include "core/rotors/aircraft.h"
#include "core/tracking/preview_maker.h"
#include "core/tracking/structure_tracker.h"
#include "core/types/attitude.h"
#include "core/types/frame.h"
#include "core/types/health.h"
#include "core/types/preview.h"
#include "firmware_app/chain/displacement_meter.h"
#include "firmware_app/service/stages/items.h"
#include "firmware_app/service/stages/thinning.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// frame ring -> StructureTracker -> DisplacementMeter -> spectrum ring and publish ring; every frame's points to
// closure, a preview at intervals to publish.
class TrackingStage : public rt::Stage {
 public:
  struct Ends {
    rt::RingReader<core::Frame> frames;
    rt::RingWriter<core::DisplacementSample> samples;
    rt::RingWriter<FrameRecord> records;
    rt::TripleBuffer<core::Preview>& previews;
    std::optional<rt::RingReader<core::AttitudeSample>> attitude = {};  // read before each frame; empty: no attitudes
    std::optional<rt::RingReader<core::AircraftState>> aircraft = {};   // likewise, and handed to spectrum
    std::optional<rt::RingWriter<AircraftUpdate>> aircraft_updates = {};
    std::optional<rt::RingWriter<ShownFrame>> tracks = {};  // frames that find no room there are counted
    // Corrected geometry by the diagnosis and its first frame. A lossless source waits for each decision.
    std::optional<rt::RingReader<CorrectionSwitch>> changes = {};
    std::optional<rt::RingWriter<Takeover>> takeovers = {};
  };
  // Objects called for each frame; not used by anyone else once the stage runs.
  struct Calls {
    core::StructureTracker& tracker;
    DisplacementMeter& meter;
    core::PreviewMaker& preview_maker;
    const ThinningSchedule& thinning;
  };
  // first_change: the diagnosis' initial one, before it has received any frame.
  TrackingStage(Ends ends, Calls calls, bool lossless, const CorrectionSwitch& first_change);

  [[nodiscard]] std::string_view name() const noexcept override { return "tracking"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

  // Any thread: from now on no frame waits for residual diagnosis.
  void stop_waiting() noexcept {
    waits_.store(false, std::memory_order_relaxed);  // independent of other data; partner: step()
    wakeup().nudge();
  }
  // Any thread: as of the newest frame.
  [[nodiscard]] std::uint64_t points_tracked() const noexcept {
    return points_tracked_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t points_total() const noexcept { return scratch_.tracks.points.size(); }
  // Any thread: as of the newest frame, and since start.
  [[nodiscard]] std::vector<core::RegionHealth> regions() const;
  // Any thread: from receipt of a frame to output of its displacement; without the first frame, taken at set-up.
  [[nodiscard]] const rt::LatencyHistogram& frame_latency() const noexcept { return frame_latency_; }
  [[nodiscard]] bool camera_given_up() const noexcept { return camera_given_up_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool attitude_given_up() const noexcept { return attitude_given_up_.load(std::memory_order_relaxed); }
  // Frames whose camera motion uses a measured attitude, too, and those that had none although attitudes are
  // configured.
  [[nodiscard]] std::uint64_t n_with_attitude() const noexcept {
    return n_with_attitude_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t n_without_attitude() const noexcept {
    return n_without_attitude_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t n_failed_frames() const noexcept { return n_failed_.load(std::memory_order_relaxed); }
  // Any thread: points that were lost and are tracked with a new template.
  [[nodiscard]] std::uint32_t n_reseeded() const noexcept { return n_reseeded_.load(std::memory_order_relaxed); }
  // Any thread: frames that publish did not receive, because its ring was full.
  [[nodiscard]] std::uint64_t n_records_lost() const noexcept {
    return n_records_lost_.load(std::memory_order_relaxed);
  }
  // Any thread: previews that publish did not send, because a newer one replaced them.
  [[nodiscard]] std::uint64_t n_previews_lost() const noexcept {
    return n_previews_lost_.load(std::memory_order_relaxed);
  }
  // Any thread: frames that closure did not receive, because its ring was full.
  [[nodiscard]] std::uint64_t n_shown_lost() const noexcept { return n_shown_lost_.load(std::memory_order_relaxed); }

 private:
  struct RegionCounts {  // written here only; relaxed: each counter is independent of other data
    std::atomic<core::RegionState> state{core::RegionState::kMeasuring};
    std::atomic<std::uint64_t> points_tracked{0}, frames_searching{0}, frames_lost{0};
    std::uint64_t points_total = 0;
  };

  [[nodiscard]] bool is_decided(std::uint64_t sequence) noexcept;  // whether the geometry for this frame is decided
  [[nodiscard]] bool is_rebuilt(std::uint64_t sequence) noexcept;  // whether this frame need not wait for a rebuild
  void begin_frame(std::uint64_t sequence) noexcept;
  void measure(const core::Frame& frame) noexcept;
  void hand_over(core::DisplacementSample* sample, FrameRecord* record) noexcept;  // null: no room
  void show(ShownFrame* slot) noexcept;                                            // null: no room
  void show_preview(const core::Frame& frame) noexcept;
  void take_attitude() noexcept;
  void take_aircraft(std::uint64_t sequence) noexcept;
  void count_frame() noexcept;
  void count_attitude() noexcept;
  void count_regions() noexcept;

  Ends ends_;
  Calls calls_;
  CorrectionSwitch decision_;  // newest
  std::uint64_t n_shown_through_ = 0;
  bool lossless_;
  std::atomic<bool> waits_{true};
  FrameRecord scratch_;
  bool gap_before_next_ = false;
  rt::LatencyHistogram frame_latency_;
  std::vector<RegionCounts> regions_;
  std::atomic<bool> attitude_given_up_{false};
  std::atomic<std::uint64_t> n_with_attitude_{0}, n_without_attitude_{0};
  std::atomic<bool> camera_given_up_{false};
  std::atomic<std::uint64_t> points_tracked_{0};  // written here only; relaxed: independent of other data
  std::atomic<std::uint64_t> n_failed_{0};
  std::atomic<std::uint64_t> n_records_lost_{0}, n_shown_lost_{0}, n_previews_lost_{0};
  std::atomic<std::uint32_t> n_reseeded_{0};
};

}  // namespace app
