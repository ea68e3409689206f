#pragma once

#include <array>

namespace core {

// How a body (X ahead, Y right, Z down) stands at one time: Hamilton quaternion w x y z that takes its axes to axes
// that rest. Any length but zero.
struct AttitudeSample {
  double t_s = 0.0;  // on the frames' clock
  std::array<double, 4> wxyz{1.0, 0.0, 0.0, 0.0};
};

}  // namespace core
