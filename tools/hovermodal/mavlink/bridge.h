#pragma once

#include <string>

#include "tools/hovermodal/answer.h"

namespace tools {

struct MavlinkOptions {
  std::string link;
  std::string url = "udpm://239.255.76.67:7667?ttl=0", prefix = "HOVERMODAL", channel = "ATTITUDE",
              aircraft_channel = "AIRCRAFT";
  bool of_gimbal = false;
  double seconds = 0.0;  // 0: until stopped
  std::string csv;       // attitudes, as camera.attitude_file reads them
  std::string motors;    // their speeds, as camera.motors_file reads them
  Answer answer;
};

// Hands what the autopilot states to a service over LCM, and the service's modes to the ground station, until stopped.
void run_mavlink(const MavlinkOptions& options);

}  // namespace tools
