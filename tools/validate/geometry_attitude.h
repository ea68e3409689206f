#pragma once

#include <vector>

#include "core/simulation/camera/camera_motion.h"
#include "core/simulation/random_stream.h"
#include "core/types/attitude.h"

namespace tools {

// Attitudes as stated by an autopilot mounted on the simulated camera, 50 times a second, with white noise about
// each axis. `motion` must outlive it.
class ToldAttitude {
 public:
  ToldAttitude(const core::simulation::CameraMotion& motion, double sigma_deg, std::uint64_t seed);

  // The samples since the last call, up to t_s.
  [[nodiscard]] const std::vector<core::AttitudeSample>& until(double t_s);

 private:
  const core::simulation::CameraMotion& motion_;
  double sigma_rad_, next_s_;
  core::simulation::RandomStream noise_;
  std::vector<core::AttitudeSample> samples_;
};

}  // namespace tools
