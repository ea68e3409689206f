#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/structure/declared_frame.h"
#include "core/types/displacement.h"
#include "core/types/frame.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "drivers/camera/camera.h"
#include "drivers/storage/folder_claim.h"
#include "drivers/telemetry/publisher.h"
#include "firmware_app/config/config.h"
#include "rt/stage_runner.h"

namespace app {

struct DataFlow;

// The whole chain from frames to modes. Construction is set-up: it opens the camera, takes the first frame, seeds the
// points, opens telemetry and report, and builds rings and stages; it may throw. Afterwards memory is fixed.
//
//   Pipeline pipeline(config);
//   pipeline.start();
//   while (pipeline.running()) ...sleep, or request_stop()...
//   const Outcome outcome = pipeline.join();
class Pipeline {
 public:
  struct Outcome {
    core::ModalEstimate estimate;      // the last one
    core::Health health;               // final counters
    std::string fault;                 // empty: done; else what went wrong (exit code 1)
    std::vector<std::string> notes;    // e.g. a truncated clip
    std::int64_t stages_ended_ns = 0;  // CLOCK_MONOTONIC at the last stage's last step, before the report is written
    std::string page;                  // path of report.html; empty: no report was requested
    bool leaves_out = false;  // the report is without an estimate, a diagnosis or a comparison that ended too late
    // A thread is still in an estimate that was not waited for: everything is written; end the process by std::_Exit.
    bool leaves_threads = false;
  };

  // Throws ConfigError (configuration does not fit the source), drivers::FolderInUse, drivers::DeviceMissing,
  // std::runtime_error.
  // Where axes are not declared they are found first, which takes the source's first seconds.
  explicit Pipeline(const AppConfig& declared);
  // The same, axes not declared taken as u, with a camera and a publisher of the caller's: for tests.
  Pipeline(AppConfig config, std::unique_ptr<drivers::Camera> camera, std::unique_ptr<drivers::Publisher> publisher);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  // Starts the threads back to front. Throws std::system_error when a real-time priority is refused and rt.required.
  void start();
  // Takes no further frame; frames already captured are processed. An estimate, a report of residual diagnosis or a
  // comparison of the declared structure that does not end in time is not waited for (kPatience...). Any thread.
  void request_stop() noexcept;
  // False when every stage has ended. Call it regularly: it also ends the other stages when one fails.
  [[nodiscard]] bool running() noexcept;
  [[nodiscard]] Outcome join();

  // How long one step of identification may go on after a stop, before the first estimate of the run and later; and one
  // of residual diagnosis.
  static constexpr std::int64_t kPatienceFirst_ns = 1'200'000'000, kPatience_ns = 3'500'000'000;

  [[nodiscard]] core::Health health() const;
  // Describes the stage that has been in one step for too long; empty: none. Any thread.
  [[nodiscard]] std::string stall() const;
  // Events of the stages since the last call, one line each.
  [[nodiscard]] std::vector<std::string> take_events();
  [[nodiscard]] const AppConfig& config() const noexcept;                                         // with the axes found
  [[nodiscard]] const std::optional<core::structure::DeclaredFrame>& structure() const noexcept;  // closure.structure
  [[nodiscard]] const core::CameraInfo& camera_info() const noexcept;
  [[nodiscard]] const std::vector<core::ChannelInfo>& channels() const noexcept;
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  void leave_the_late() noexcept;
  [[nodiscard]] bool is_left(const rt::StageRunner& runner) const noexcept;

  std::vector<std::shared_ptr<drivers::FolderClaim>> claims_;  // of the folders that the run writes into
  std::unique_ptr<DataFlow> flow_;
  std::atomic<std::int64_t> stop_ns_{0};  // CLOCK_MONOTONIC of the first request; relaxed: independent; 0: none
  bool leaves_estimate_ = false, leaves_diagnosis_ = false, leaves_comparison_ = false;  // main thread
};

// Checks all that can be checked without running: opens the source, compares regions, seeds. For --check. Returns how
// even a recording's times are, in words; empty: not a recording.
std::string check_source(const AppConfig& declared);

}  // namespace app
