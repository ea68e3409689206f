#include "core/geometry/gyro_readout.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/geometry/gyro_attitude.h"
#include "tests/support/shaken_camera.h"

namespace core {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using test_support::kFocal_px;
using test_support::kFrame_s;
using test_support::kOffset_s;
using test_support::ShakenCamera;

TEST(GyroReadout, FindsTheReadoutOfACameraThatIsCarriedAhead) {
  for (const double frames : {-1.0, -0.4, 0.0, 0.5, 1.0}) {
    const ShakenCamera clip(frames * kFrame_s, 0.05, 7);
    const GyroReadout found = fit_gyro_readout(clip.pairs, clip.gyro, clip.config);
    EXPECT_NEAR(found.readout.readout_s / kFrame_s, frames, 0.02) << frames;
    EXPECT_LT(std::abs(found.readout.readout_s - frames * kFrame_s), 3.5 * found.readout.std_s + 1e-5) << frames;
    EXPECT_NEAR(found.offset_s, kOffset_s, 1e-3) << frames;
    EXPECT_NEAR(found.sigma_px, 0.07, 0.04) << frames;
    if (frames == 0.0) continue;
    EXPECT_LT(found.rms_with_px, found.rms_without_px) << frames;
  }
}

TEST(GyroReadout, StatesAnHonestDeviation) {
  double squares = 0.0;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ShakenCamera clip(0.7 * kFrame_s, 0.15, seed);
    const GyroReadout found = fit_gyro_readout(clip.pairs, clip.gyro, clip.config);
    const double z = (found.readout.readout_s - 0.7 * kFrame_s) / found.readout.std_s;
    EXPECT_LT(std::abs(z), 5.0) << seed;
    EXPECT_LT(found.readout.std_s, 0.05 * kFrame_s) << seed;
    squares += z * z;
  }
  EXPECT_GT(std::sqrt(squares / kSeeds), 0.3);
  EXPECT_LT(std::sqrt(squares / kSeeds), 2.0);
}

TEST(GyroReadout, FindsTheFocalLengthToo) {
  ShakenCamera clip(0.6 * kFrame_s, 0.05, 3);
  clip.config.focal_px = 0.0;
  const GyroReadout found = fit_gyro_readout(clip.pairs, clip.gyro, clip.config);
  EXPECT_NEAR(found.focal_px, kFocal_px, 0.03 * kFocal_px);
  EXPECT_NEAR(found.readout.readout_s / kFrame_s, 0.6, 0.03);
}

std::string refusal(const ShakenCamera& clip) {
  try {
    (void)fit_gyro_readout(clip.pairs, clip.gyro, clip.config);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no refusal";
}

TEST(GyroReadout, RefusesWhatTellsNothing) {
  const ShakenCamera sound(0.0, 0.05, 1);
  ShakenCamera clip = sound;
  clip.pairs.resize(5);
  EXPECT_NE(refusal(clip).find("frame pairs to fit"), std::string::npos);
  clip = sound;
  clip.gyro.resize(clip.gyro.size() / 2);
  EXPECT_NE(refusal(clip).find("does not cover the frames"), std::string::npos);
  clip = sound;
  clip.gyro[10].rate_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(clip).find("gyro sample 10"), std::string::npos);
  clip = sound;
  clip.gyro[11].t_s = clip.gyro[10].t_s;
  EXPECT_NE(refusal(clip).find("gyro sample 11"), std::string::npos);
  clip = sound;
  for (FramePair& pair : clip.pairs) {
    for (PointPair& point : pair.points) point.to = point.from;
  }
  EXPECT_NE(refusal(clip).find("hardly rotates"), std::string::npos);
}

TEST(GyroAttitude, IntegratesLinearRatesAndInterpolatesBetweenSamples) {
  std::vector<GyroSample> gyro;
  for (int k = 0; k <= 100; ++k) gyro.push_back({0.01 * k, Vector3d(0.0, 0.0, 0.2 + 0.5 * 0.01 * k + 0.01)});
  const GyroAttitude attitude(gyro, Vector3d(0.0, 0.0, 0.01));
  for (const double t_s : {0.0, 0.013, 0.5, 0.987, 1.0}) {
    const Quaterniond expected(Eigen::AngleAxisd(0.2 * t_s + 0.25 * t_s * t_s, Vector3d::UnitZ()));
    EXPECT_LT(attitude(t_s).angularDistance(expected), 1e-9) << t_s;
  }
}

}  // namespace
}  // namespace core
