#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "core/types/health.h"
#include "drivers/telemetry/sample_listener.h"
#include "firmware_app/service/stages/capture_stage.h"
#include "firmware_app/service/stages/checkpoint_stage.h"
#include "firmware_app/service/stages/publish_stage.h"
#include "firmware_app/service/stages/spectrum_stage.h"
#include "firmware_app/service/stages/tracking_stage.h"
#include "rt/stage_runner.h"

namespace app {

// Gathers every stage's counters into one status record. Any thread may collect; the counters are atomics.
class HealthCollector {
 public:
  struct Queue {
    const rt::StageRunner* runner = nullptr;
    std::function<std::size_t()> depth;  // of the ring it reads; empty = none
    std::size_t n_slots = 0;
  };

  HealthCollector(double rate_hz, const CaptureStage& capture, const TrackingStage& tracking,
                  const SpectrumStage& spectrum)
      : rate_hz_(rate_hz), capture_(capture), tracking_(tracking), spectrum_(spectrum) {}

  // Set-up only.
  void watch(Queue queue) { queues_.push_back(std::move(queue)); }
  void name_regions(std::vector<std::string> names) { region_names_ = std::move(names); }  // as configured
  void watch_camera(const drivers::Camera& camera) { camera_ = &camera; }
  void watch_record(const drivers::RunRecorder& recorder) { recorder_ = &recorder; }
  void watch_attitude(const drivers::AttitudeListener& listener) { listener_ = &listener; }
  void watch_aircraft(const drivers::AircraftListener& listener) { aircraft_ = &listener; }
  void watch_state(const CheckpointStage& checkpoint) { checkpoint_ = &checkpoint; }

  // Any thread.
  void warn(std::string warning);

  [[nodiscard]] core::Health collect(const drivers::Publisher& publisher) const;
  // "stage tracking: one step has taken 3.2 s"; empty: all stages run.
  [[nodiscard]] std::string stall() const;

 private:
  void add_stages(core::Health& health) const;

  double rate_hz_;
  const CaptureStage& capture_;
  const TrackingStage& tracking_;
  const SpectrumStage& spectrum_;
  const drivers::Camera* camera_ = nullptr;
  const drivers::RunRecorder* recorder_ = nullptr;       // null: the run is not recorded
  const drivers::AttitudeListener* listener_ = nullptr;  // null: no live attitude
  const drivers::AircraftListener* aircraft_ = nullptr;  // null: not listened for
  const CheckpointStage* checkpoint_ = nullptr;          // null: no checkpoints
  std::vector<Queue> queues_;
  std::vector<std::string> region_names_;
  mutable std::mutex warnings_mutex_;
  std::vector<std::string> warnings_;
};

}  // namespace app
