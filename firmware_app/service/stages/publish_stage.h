#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/preview.h"
#include "drivers/telemetry/publisher.h"
#include "drivers/telemetry/run_recorder.h"
#include "firmware_app/config/config.h"
#include "firmware_app/report/run_report.h"
#include "firmware_app/service/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// records and estimates -> telemetry and the report's files. The only stage that may use files and sockets.
class PublishStage : public rt::Stage {
 public:
  // The latest items of the run so far. Null: none.
  struct Findings {
    const core::ModalEstimate& estimate;
    const core::CpsdSums& spectrum;
    const core::closure::ClosureReport* closure;
  };
  struct Outlets {
    drivers::Publisher& publisher;
    drivers::RunRecorder* recorder = nullptr;  // null: the run is not recorded
    RunReport* report = nullptr;               // null: no report requested
    std::function<core::Health()> health;      // returns the present status record
    // Draws the run's pictures and its page into a folder; throws drivers::FileError. Empty: not requested.
    std::function<void(const Findings&, const core::Health&, const std::string& folder)> draw;
    std::vector<core::ChannelInfo> channels;
    std::vector<std::string> corrections, caveats;
    TelemetryConfig telemetry;
    std::vector<core::Region> regions;
    // Caveats that the run itself found; asked once, after every other stage has ended. Empty: none.
    std::function<std::vector<std::string>()> findings = {};
  };

  struct Ends {
    rt::RingReader<FrameRecord> records;
    rt::RingReader<IdentificationResult> results;
    rt::TripleBuffer<core::Preview>& previews;  // the newest one is sent
    std::optional<rt::RingReader<core::closure::ClosureReport>> closures = {};
    std::optional<rt::RingReader<core::closure::ClosureReport>> comparisons = {};  // of the declared structure
  };
  PublishStage(Ends ends, Outlets outlets);

  [[nodiscard]] std::string_view name() const noexcept override { return "publish"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

  // What of a stopped run is not waited for any more, because it takes too long.
  enum Late : std::uint32_t { kEstimate = 1, kDiagnosis = 2, kComparison = 4 };
  // Any thread. The report is completed without it and says so, unless it arrives before everything else has ended.
  void go_on_without(Late late) noexcept {
    late_.fetch_or(late, std::memory_order_relaxed);  // independent of other data; partner: step(), finish()
    wakeup().nudge();
  }
  // Any thread: estimates published so far. Stored with release after `last_estimate_` is complete; see
  // last_estimate().
  [[nodiscard]] std::uint64_t n_estimates() const noexcept { return n_estimates_.load(std::memory_order_acquire); }
  // Call after the thread has ended. `left_out`: set of Late, what the report is without.
  [[nodiscard]] std::uint32_t left_out() const noexcept { return left_out_; }
  [[nodiscard]] const core::ModalEstimate& last_estimate() const noexcept { return last_estimate_; }
  [[nodiscard]] const std::string& fault() const noexcept { return fault_; }  // empty = none

 private:
  void publish_record(const FrameRecord& record) noexcept;
  void publish_result(const IdentificationResult& result) noexcept;
  void publish_closure(const core::closure::ClosureReport& report) noexcept;
  void publish_health_when_due() noexcept;
  // The items of `late` that have still not arrived.
  [[nodiscard]] std::uint32_t missing(std::uint32_t late) noexcept;
  void complete_report(const core::Health& health);
  [[nodiscard]] const core::closure::ClosureReport* closure() const noexcept {
    return last_closure_ ? &*last_closure_ : nullptr;
  }

  Ends ends_;
  Outlets outlets_;
  core::ModalEstimate last_estimate_;
  core::CpsdSums last_sums_;
  std::optional<core::closure::ClosureReport> last_closure_;
  std::string fault_;
  std::uint64_t n_records_ = 0;
  std::int64_t next_health_ns_ = 0;
  std::atomic<std::uint64_t> n_estimates_{0};
  std::atomic<std::uint32_t> late_{0};
  std::uint32_t left_out_ = 0;
};

}  // namespace app
