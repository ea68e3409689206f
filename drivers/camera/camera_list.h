#pragma once

#include <string>
#include <vector>

namespace drivers {

// A camera that the service could use now.
struct AttachedCamera {
  std::string driver;  // camera.driver
  std::string source;  // camera.source: a name that stays the same when it is plugged in again, if it has one
  std::string name;    // as the camera calls itself, and what it hangs on
  std::vector<std::string> modes;   // formats, sizes, rates
  std::string stamps;               // which instant its time stamps mean
  std::string locks;                // what can be kept from changing; empty = not known before it runs
  std::string problem;              // why it cannot be used now; empty = it can
  int width_px = 0, height_px = 0;  // as the service would choose; 0 = known only when it runs
  double rate_hz = 0.0;
  std::string format;
};

// V4L2 nodes that capture, then what libcamera sees (where it is built in). Opens each for a moment; one that is in use
// is listed with that problem.
[[nodiscard]] std::vector<AttachedCamera> list_cameras();

}  // namespace drivers
