#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/motion_axes.h"
#include "firmware_app/config/config.h"

namespace app {

// Finds the axes that a configuration does not declare, from the tracks of the first seconds: until the motion has one
// clear direction (asked after 4, 8 and 16 s), at most kLongest_s.
class AxisSearch {
 public:
  static constexpr double kLongest_s = 30.0;

  AxisSearch(const AppConfig& config, std::size_t n_points);
  [[nodiscard]] bool is_settled_by(const core::TrackFrame& frame) noexcept;  // no further frame is needed
  void take(AppConfig& config) const;                                        // the axes found

 private:
  std::vector<core::Region> regions_;
  core::MotionAxes axes_;
  double ask_s_;
};

}  // namespace app
