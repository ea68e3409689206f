#pragma once

#include <string>
#include <vector>

namespace drivers {

// A camera that the service could use now.
struct AttachedCamera {
  std::string driver;               // camera.driver
  std::string source;               // camera.source: a name that remains the same after reconnection, if there is one
  std::string name;                 // the camera's own name, and the bus it is connected to
  std::vector<std::string> modes;   // formats, sizes, rates
  std::string stamps;               // the instant that its time stamps refer to
  std::string locks;                // properties that can be locked; empty = not known before it runs
  std::string problem;              // why it cannot be used now; empty: it can
  int width_px = 0, height_px = 0;  // as the service would choose; 0 = known only while it runs
  double rate_hz = 0.0;
  std::string format;
};

// V4L2 nodes that capture, then the cameras of libcamera (where it is built in). Opens each briefly; one that is in use
// is listed with that problem.
[[nodiscard]] std::vector<AttachedCamera> list_cameras();

}  // namespace drivers
