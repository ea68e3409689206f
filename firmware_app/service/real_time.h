#pragma once

#include <stdexcept>
#include <string>

#include "firmware_app/config/config.h"
#include "firmware_app/service/health.h"
#include "rt/stage_runner.h"

namespace app {

// Handles a real-time setting that the system refuses: an error when rt.required, else a warning in every status
// record.
void refuse_or_warn(const RtConfig& config, const std::string& refused, HealthCollector& health);
// For threads on the frames' path: rt.priority, their CPU, and a stack that is mapped beforehand.
[[nodiscard]] rt::ThreadConfig frame_thread(std::string name, const RtConfig& config, int cpu);
void start_runner(rt::StageRunner& runner, const RtConfig& config, HealthCollector& health);

// Thrown by refuse_or_warn() and start_runner() (exit code 4).
class RealTimeRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace app
