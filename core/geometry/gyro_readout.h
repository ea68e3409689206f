#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/types/readout.h"
#include "core/types/vector2.h"

namespace core {

// Readout time of a hand-rotated camera, from a gyro and the image motion. Under pure rotation a point at bearing p_1
// in one frame is seen in the next at
//     R G(t_2)^T G(t_1) R^T p_1      t = frame's stamp + T_r x readout fraction of the point + clock offset
// G the gyro's attitude (integrated rates minus a constant bias), R from gyro axes to camera axes (X right, Y down, Z
// forward), pinhole of focal length f. Unknown: T_r, clock offset, f if not given, bias, R [Karpenko et al. 2011; Jia &
// Evans 2014]. A carried camera also translates: every pair has its own translation, and every point its own unknown
// depth, so the residual is the distance of points from their epipolar lines (derotated_flow.h). Start:
// start_from_turns; then maximum likelihood by Levenberg-Marquardt, translations eliminated (Schur complement), the
// points' noise estimated too; of three initial readouts the most likely result is used. Standard deviations: sandwich
// over frame pairs, with correlated neighbouring scores [Newey & West 1987].

struct GyroSample {
  double t_s = 0.0;
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
};

// A point in two successive frames: undistorted pixels, and the readout fraction (0 .. 1) of its raw pixel.
struct PointPair {
  Vector2 from, to;
  double from_fraction = 0.0, to_fraction = 0.0;
};

struct FramePair {
  double from_s = 0.0, to_s = 0.0;  // start of exposure of row 0
  std::vector<PointPair> points;
  bool held_out = false;  // excluded from the fit
};

struct GyroReadoutConfig {
  double focal_px = 0.0;  // 0 = unknown
  double cx_px = 0.0, cy_px = 0.0;
  double width_px = 0.0;
  double most_offset_s = 0.1;  // largest clock offset considered

  // How long before the first and after the last frame the gyro must have measured.
  [[nodiscard]] double beyond_s() const noexcept { return most_offset_s + 0.1; }
};

struct GyroReadout {
  ReadoutValue readout;
  std::array<ReadoutValue, 2> halves;         // from the first and the second half of the record alone
  double offset_s = 0.0, offset_std_s = 0.0;  // add to stamps to convert them to the gyro's clock
  double focal_px = 0.0, focal_std_px = 0.0;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // R
  double sigma_px = 0.0;                               // of a point, per axis
  // Rms distance of the points of held-out frames from their epipolar lines: with a readout of zero and everything else
  // fitted; and with the estimated readout. Points beyond 5 sigma_px in both are excluded, because they move by
  // themselves.
  double rms_without_px = 0.0, rms_with_px = 0.0;
  std::vector<double> pair_rms_without_px, pair_rms_with_px;  // every pair
};

// Throws std::invalid_argument: fewer than eight pairs with points, or a gyro record that does not cover them.
void check_gyro_record(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                       const GyroReadoutConfig& config);

// Throws as check_gyro_record(), and std::invalid_argument if the camera does not rotate.
[[nodiscard]] GyroReadout fit_gyro_readout(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                                           const GyroReadoutConfig& config);

}  // namespace core
