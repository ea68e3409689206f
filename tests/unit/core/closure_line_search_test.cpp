#include <gtest/gtest.h>

#include <cmath>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/held_out.h"
#include "core/closure/observation/kinds/line_effect.h"
#include "core/closure/observation/line_search.h"
#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using test_support::kPi;

constexpr double kReadout_frames = 0.7;
constexpr Eigen::Index kFrames = 1500;

struct LineFit {
  LineFinding finding;
  double share_left = 0.0;  // rms, relative to the rotation's own
};

// Roll at frequency_hz that wanders slowly by +-wander_hz, on points that are static except for their noise.
LineFit fit_line(double frequency_hz, double wander_hz) {
  ObservationRecord record = test_support::swaying_record(kFrames, {});
  record.readout_frames = kReadout_frames;
  const Eigen::RowVectorXd u = record.u_px.colwise().mean(), v = record.v_px.colwise().mean();
  NoiseStream noise(5);
  Eigen::MatrixXd positions(2 * record.n_points(), kFrames), rotation = positions;
  for (Eigen::Index k = 0; k < kFrames; ++k) {
    for (Eigen::Index j = 0; j < record.n_points(); ++j) {
      const double t = (static_cast<double>(k) + kReadout_frames * v(j) / record.height_px) / record.rate_hz;
      const double cycles = frequency_hz * t + wander_hz / (2.0 * kPi * 0.1) * std::sin(2.0 * kPi * 0.1 * t);
      const double roll = 1e-3 * std::sin(2.0 * kPi * cycles);
      rotation(2 * j, k) = roll * (v(j) - record.cy_px);
      rotation(2 * j + 1, k) = -roll * (u(j) - record.cx_px);
      positions(2 * j, k) = u(j) + rotation(2 * j, k) + 0.01 * noise.gaussian();
      positions(2 * j + 1, k) = v(j) + rotation(2 * j + 1, k) + 0.01 * noise.gaussian();
      record.u_px(k, j) = positions(2 * j, k), record.v_px(k, j) = positions(2 * j + 1, k);
    }
  }
  PointMotionModel model(record);
  model.solve(positions, kReadout_frames, 1);
  const auto rotor = std::unique_ptr<ObservationEffect>(make_rotor_line());
  const LineSearch search(model, record.rate_hz, kReadout_frames,
                          dynamic_cast<const LineEffect&>(*rotor).patterns(model.geometry(), kReadout_frames), kFrames);
  LineFit fit{search.find(residual_moments(model.residual(), record.rate_hz).spectrum), 0.0};
  const Eigen::MatrixXd later = Eigen::MatrixXd::Zero(record.n_points(), kFrames);
  Eigen::MatrixXd motion = search.motion(model.residual(), fit.finding, later).px;
  for (int round = 0; round < 6; ++round) {  // recovers the part of the line that the regions' free motion had absorbed
    model.solve(positions - motion, kReadout_frames, 1);
    motion += search.motion(model.residual(), fit.finding, later).px;
  }
  fit.share_left = (rotation - motion).norm() / rotation.norm();
  return fit;
}

TEST(LineSearch, TellsTheFrequencyAmongThoseThatLookAlike) {
  const LineFit fit = fit_line(82.0, 0.3);
  EXPECT_NEAR(std::abs(fit.finding.apparent_hz + fit.finding.fold * 25.0), 82.0, 0.35);
  EXPECT_LT(fit.share_left, 0.05);
}

// 87.7 Hz at 25 fps appears at 12.3 Hz; below 87.5 Hz the line appears below 12.5 Hz as well, mirrored.
TEST(LineSearch, ALineThatWandersOverHalfTheFrameRateIsHeldOnBothSides) {
  const LineFit fit = fit_line(87.7, 0.6);
  EXPECT_NEAR(std::abs(fit.finding.apparent_hz + fit.finding.fold * 25.0), 87.7, 0.7);
  EXPECT_LT(fit.share_left, 0.1);
}

// 77 Hz at 25 fps appears at 2 Hz, among the camera's own slow rotations: only the rows distinguish the two.
TEST(LineSearch, FindsALineThatAppearsAmongSlowRotations) {
  const LineFit fit = fit_line(77.0, 0.3);
  EXPECT_NEAR(std::abs(fit.finding.apparent_hz + fit.finding.fold * 25.0), 77.0, 0.35);
  EXPECT_LT(fit.share_left, 0.05);
}

TEST(LineSearch, ASlowRotationIsNoLine) {
  const LineFit fit = fit_line(2.0, 0.1);
  EXPECT_TRUE(fit.finding.fold == 0 || fit.finding.apparent_hz >= LineSearch::kSlowest_hz);
  EXPECT_FALSE(fit.finding.is_steady(25.0, kReadout_frames));
}

}  // namespace
}  // namespace core::closure
