#include "core/geometry/gyro_readout.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/geometry/gyro_attitude.h"

namespace core {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30.0, kFocal_px = 580.0, kWidth_px = 800.0, kHeight_px = 600.0;
constexpr double kOffset_s = 0.012;

// Body rates of a hand that shakes: some tones about each axis.
Vector3d rate_at(double t_s, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Vector3d rate = Vector3d::Zero();
  for (int tone = 0; tone < 5; ++tone) {
    for (int axis = 0; axis < 3; ++axis) {
      const double hz = 0.7 + 7.0 * unit(random), phase = 6.283 * unit(random);
      rate[axis] += 0.25 * std::sin(6.283185307 * hz * t_s + phase);
    }
  }
  return rate;
}

// A camera that shakes and is carried ahead through points at 4 ... 60 m; its gyro lies as a phone's does.
class ShakenCamera {
 public:
  ShakenCamera(double readout_s, double noise_px, std::uint64_t seed) : readout_s_(readout_s), random_(seed) {
    constexpr double kStep_s = 2e-4;
    Quaterniond q = Quaterniond::Identity();
    for (double t_s = kStart_s; t_s < kEnd_s; t_s += kStep_s) {
      turns_.push_back(q);
      const Vector3d middle = rate_at(t_s + 0.5 * kStep_s, seed) * kStep_s;
      q = (q * Quaterniond(Eigen::AngleAxisd(middle.norm(), middle.normalized()))).normalized();
    }
    for (double t_s = kStart_s + 0.01; t_s < kEnd_s - 0.01; t_s += 0.0025) {
      gyro.push_back({t_s + kOffset_s, rate_at(t_s, seed) + Vector3d(0.004, -0.003, 0.002)});
    }
    for (int k = 0; k < 28; ++k) add_pair(k * kFrame_s, noise_px);
  }
  std::vector<FramePair> pairs;
  std::vector<GyroSample> gyro;
  GyroReadoutConfig config{kFocal_px, 0.5 * (kWidth_px - 1.0), 0.5 * (kHeight_px - 1.0), kWidth_px, 0.1};

 private:
  static constexpr double kStart_s = -0.5, kEnd_s = 2.0;

  // Camera axes to the world; the gyro's X is the camera's -Y, its Y the camera's -X, its Z the camera's -Z.
  [[nodiscard]] Quaterniond camera_at(double t_s) const {
    Eigen::Matrix3d axes;
    axes << 0.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
    const auto i = static_cast<std::size_t>((t_s - kStart_s) / 2e-4);
    return turns_[i] * Quaterniond(Eigen::Matrix3d(axes.transpose()));
  }
  [[nodiscard]] Vector2 seen(const Vector3d& world, double frame_s) const {
    Vector2 at{0.0, 0.5 * kHeight_px};
    for (int round = 0; round < 6; ++round) {
      const double t_s = frame_s + readout_s_ * at.v / kHeight_px;
      const Vector3d place(0.2 * t_s, -0.1 * t_s, 3.0 * t_s);
      const Vector3d ray = camera_at(t_s).conjugate() * (world - place);
      at = {config.cx_px + kFocal_px * ray.x() / ray.z(), config.cy_px + kFocal_px * ray.y() / ray.z()};
    }
    return at;
  }
  void add_pair(double frame_s, double noise_px) {
    FramePair pair;
    pair.from_s = frame_s;
    pair.to_s = frame_s + kFrame_s;
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> noise(0.0, noise_px);
    for (int i = 0; i < 28; ++i) {
      const double depth = 4.0 * std::pow(15.0, unit(random_));
      const Vector3d ray((unit(random_) - 0.5) * kWidth_px / kFocal_px, (unit(random_) - 0.5) * kHeight_px / kFocal_px,
                         1.0);
      const Vector3d world = camera_at(frame_s) * (depth * ray) + Vector3d(0.2, -0.1, 3.0) * frame_s;
      Vector2 from = seen(world, pair.from_s), to = seen(world, pair.to_s);
      from.u += noise(random_), from.v += noise(random_), to.u += noise(random_), to.v += noise(random_);
      if (i % 10 == 0) to.u += 20.0 * unit(random_);  // moves by itself
      pair.points.push_back({from, to, from.v / kHeight_px, to.v / kHeight_px});
    }
    pair.held_out = pairs.size() % 4 == 3;
    pairs.push_back(pair);
  }

  double readout_s_;
  std::mt19937_64 random_;
  std::vector<Quaterniond> turns_;
};

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
  EXPECT_NE(refusal(clip).find("does not hold the frames"), std::string::npos);
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
  EXPECT_NE(refusal(clip).find("hardly turns"), std::string::npos);
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
