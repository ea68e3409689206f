#pragma once

#include <string>
#include <vector>

#include "core/types/attitude.h"

namespace drivers {

// A CSV of attitudes. Its first line names the columns and their units, in any order, others are ignored:
//   time       t_s | t_ms | t_us | t_ns, on the frames' clock (a video's first frame is at its own time stamp, 0)
//   attitude   roll_deg, pitch_deg, yaw_deg (or _rad; aerospace: R_z(yaw) R_y(pitch) R_x(roll) takes body axes, X
//              ahead, Y right, Z down, to axes fixed in space), or qw, qx, qy, qz of the same rotation
// `#` lines are comments. Throws FileError "FILE:LINE: ..." (with the column) on a missing file or column, text in
// place of a number, a quaternion of zero length, times that do not increase, fewer than two rows.
[[nodiscard]] std::vector<core::AttitudeSample> read_attitude_csv(const std::string& path);

}  // namespace drivers
