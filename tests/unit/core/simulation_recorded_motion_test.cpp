#include "core/simulation/camera/recorded_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace core::simulation {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

core::FlightPath slow_circle(std::size_t n = 300) {
  core::FlightPath path;
  path.rate_hz = 10.0;
  path.from_s = 360.7;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) / 10.0;
    path.north_mm.push_back(100.0 * std::sin(kTwoPi * 0.2 * t));
    path.east_mm.push_back(50.0 * std::cos(kTwoPi * 0.2 * t));
    path.up_mm.push_back(10.0 * std::sin(kTwoPi * 0.1 * t));
  }
  return path;
}

// Tilted by constant angles and without motion except for `acceleration` in level axes (forward, left, up).
core::FlightAttitude tilted(std::size_t n, double roll, double pitch,
                            const std::function<double(int, double)>& acceleration) {
  core::FlightAttitude out;
  out.rate_hz = 120.0;
  out.from_s = 180.5;
  out.mean_roll_rad = roll, out.mean_pitch_rad = pitch;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) / 120.0;
    out.roll_rad.push_back(0.01 * std::sin(t)), out.pitch_rad.push_back(0.02 * std::cos(t)), out.yaw_rad.push_back(0.1);
    const double phi = roll + out.roll_rad.back(), theta = pitch + out.pitch_rad.back();
    const double f = acceleration(0, t), l = acceleration(1, t), u = acceleration(2, t) + 9.80665;
    // From the level to the sensor: back by pitch, then by roll.
    const double x = f * std::cos(theta) - u * std::sin(theta), up = f * std::sin(theta) + u * std::cos(theta);
    out.x_m_s2.push_back(x);
    out.y_m_s2.push_back(l * std::cos(phi) + up * std::sin(phi));
    out.z_m_s2.push_back(-l * std::sin(phi) + up * std::cos(phi));
  }
  return out;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "nothing refused";
}

TEST(RecordedMotion, FacingTurnsNorthEastUpIntoCameraAxes) {
  const core::FlightPath path = slow_circle();
  const struct {
    double facing;
    std::function<double(std::size_t)> x, z;
  } cases[] = {
      {0.0, [&](std::size_t k) { return path.east_mm[k]; }, [&](std::size_t k) { return path.north_mm[k]; }},
      {90.0, [&](std::size_t k) { return -path.north_mm[k]; }, [&](std::size_t k) { return path.east_mm[k]; }},
      {180.0, [&](std::size_t k) { return -path.east_mm[k]; }, [&](std::size_t k) { return -path.north_mm[k]; }}};
  for (const auto& c : cases) {
    const RecordedMotion motion = make_recorded_motion(path, nullptr, {c.facing, 0.02, 0.0});
    ASSERT_EQ(motion.x_mm.size(), path.n_samples());
    EXPECT_DOUBLE_EQ(motion.rate_hz, 10.0);
    for (std::size_t k = 0; k < path.n_samples(); k += 17) {
      EXPECT_NEAR(motion.x_mm[k], c.x(k), 1e-9);
      EXPECT_NEAR(motion.y_mm[k], -path.up_mm[k], 1e-9);
      EXPECT_NEAR(motion.z_mm[k], c.z(k), 1e-9);
      EXPECT_EQ(motion.pitch_rad[k], 0.0);
    }
  }
}

TEST(RecordedMotion, GimbalLeavesAShareOfTheAttitudeInCameraAxes) {
  const auto none = [](int, double) { return 0.0; };
  const core::FlightAttitude attitude = tilted(3600, 0.0, 0.0, none);
  const RecordedMotion motion = make_recorded_motion(slow_circle(), &attitude, {0.0, 0.05, 0.0});
  EXPECT_DOUBLE_EQ(motion.rate_hz, 120.0);
  ASSERT_EQ(motion.x_mm.size(), 3589U);  // 29.9 s
  EXPECT_NEAR(motion.roll_rad[100], 0.05 * attitude.roll_rad[100], 1e-15);
  EXPECT_NEAR(motion.pitch_rad[100], -0.05 * attitude.pitch_rad[100], 1e-15);  // nose up is left-handed about X right
  EXPECT_NEAR(motion.yaw_rad[100], -0.05 * attitude.yaw_rad[100], 1e-15);
  // Positions of 10 Hz on the 120 Hz grid: 0.2 Hz has 50 samples a cycle.
  EXPECT_NEAR(motion.z_mm[1207], 100.0 * std::sin(kTwoPi * 0.2 * 1207.0 / 120.0), 1e-3);
}

TEST(RecordedMotion, AccelerationsBecomeDisplacement) {
  std::vector<double> a;
  for (int k = 0; k < 2400; ++k) a.push_back(3.0 * std::sin(kTwoPi * 6.0 * k / 120.0) + 1.7);
  const std::vector<double> x = displacement_mm(a, 120.0, 2.0);
  const double amplitude = 3.0e3 / std::pow(kTwoPi * 6.0, 2);  // 2.11 mm
  for (int k = 240; k < 2160; ++k) {                           // a second from the ends, which fade
    EXPECT_NEAR(x[static_cast<std::size_t>(k)], -amplitude * std::sin(kTwoPi * 6.0 * k / 120.0), 0.02 * amplitude);
  }
  EXPECT_LT(std::abs(x.front()), 0.1 * amplitude);
  EXPECT_LT(std::abs(x.back()), 0.1 * amplitude);
}

TEST(RecordedMotion, BelowTheLowestFrequencyNothingPasses) {
  std::vector<double> a;
  for (int k = 0; k < 4800; ++k) a.push_back(std::sin(kTwoPi * 0.5 * k / 120.0));
  const double whole = 1e3 / std::pow(kTwoPi * 0.5, 2);  // 101 mm
  for (const double value : displacement_mm(a, 120.0, 2.0)) EXPECT_LT(std::abs(value), 0.01 * whole);
}

TEST(RecordedMotion, VibrationIsLevelledAndFreeOfGravity) {
  const auto shake = [](int axis, double t) { return (1.0 + axis) * std::sin(kTwoPi * 5.0 * t); };
  const core::FlightAttitude attitude = tilted(3600, 0.3, -0.2, shake);
  core::FlightPath still = slow_circle();
  for (auto* series : {&still.north_mm, &still.east_mm, &still.up_mm}) series->assign(300, 0.0);
  const RecordedMotion motion = make_recorded_motion(still, &attitude, {40.0, 0.0, 2.0});
  const double unit = 1e3 / std::pow(kTwoPi * 5.0, 2);
  for (std::size_t k = 360; k < 3000; k += 7) {
    const double s = -unit * std::sin(kTwoPi * 5.0 * static_cast<double>(k) / 120.0);
    EXPECT_NEAR(motion.z_mm[k], s, 0.03 * unit);         // forward
    EXPECT_NEAR(motion.x_mm[k], -2.0 * s, 0.03 * unit);  // left is -X
    EXPECT_NEAR(motion.y_mm[k], -3.0 * s, 0.03 * unit);  // up is -Y
  }
}

TEST(RecordedMotion, RefusesAnAttitudeThatCoversTooLittleAndNamesTheSeconds) {
  const core::FlightAttitude attitude = tilted(1200, 0.0, 0.0, [](int, double) { return 0.0; });
  const std::string text = refusal([&] { (void)make_recorded_motion(slow_circle(), &attitude, {}); });
  EXPECT_NE(text.find("covers 180.5 to 190.492 s"), std::string::npos) << text;
  EXPECT_NE(text.find("360.7 to 390.6 s"), std::string::npos) << text;
}

TEST(RecordedMotion, RefusesBadUse) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const core::FlightPath path = slow_circle();
  EXPECT_NE(refusal([&] {
              (void)make_recorded_motion(path, nullptr, {nan, 0.02, 0.0});
            }).find("facing"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              (void)make_recorded_motion(path, nullptr, {0.0, -1.0, 0.0});
            }).find("gimbal"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              (void)make_recorded_motion(path, nullptr, {0.0, 0.02, 2.0});
            }).find("accelerations"),
            std::string::npos);
  EXPECT_NE(refusal([&] { (void)displacement_mm(std::vector<double>(2400), 120.0, 60.0); }).find("0.4"),
            std::string::npos);
  EXPECT_NE(refusal([&] { (void)displacement_mm(std::vector<double>(100), 120.0, 2.0); }).find("four seconds"),
            std::string::npos);
  core::FlightPath broken = path;
  broken.east_mm[7] = nan;
  EXPECT_NE(refusal([&] { (void)make_recorded_motion(broken, nullptr, {}); }).find("east is nan"), std::string::npos);
  broken = path;
  broken.up_mm.pop_back();
  EXPECT_NE(refusal([&] { (void)make_recorded_motion(broken, nullptr, {}); }).find("equally long"), std::string::npos);
}

TEST(RecordedPath, IsTheMotionBetweenItsSamplesAndMirroredBeyond) {
  const RecordedMotion motion = make_recorded_motion(slow_circle(), nullptr, {});
  const RecordedPath path(motion);
  EXPECT_DOUBLE_EQ(path.duration_s(), 29.9);
  EXPECT_NEAR(path.at(2, 12.345), 100.0 * std::sin(kTwoPi * 0.2 * 12.345), 1e-3);
  EXPECT_NEAR(path.at(0, 29.9 + 3.0), path.at(0, 29.9 - 3.0), 1e-9);
  EXPECT_NEAR(path.rms()[2], 100.0 / std::numbers::sqrt2, 0.5);
  EXPECT_EQ(path.rms()[3], 0.0);
  EXPECT_EQ(path.at(3, 1.0), 0.0);
  EXPECT_EQ(path.at(-1, 1.0), 0.0);
  EXPECT_EQ(path.at(6, 1.0), 0.0);
}

TEST(RecordedPath, RefusesWhatIsNoMotion) {
  RecordedMotion motion;
  EXPECT_THROW(RecordedPath{motion}, std::invalid_argument);
  motion.rate_hz = 10.0;
  EXPECT_THROW(RecordedPath{motion}, std::invalid_argument);
  motion.x_mm = {1, 2, 3, 4, 5};
  EXPECT_NO_THROW(RecordedPath{motion});  // the other axes do not move
  motion.y_mm = {1, 2, 3, 4};
  EXPECT_THROW(RecordedPath{motion}, std::invalid_argument);
  motion.y_mm = {1, 2, 3, 4, std::numeric_limits<double>::infinity()};
  EXPECT_THROW(RecordedPath{motion}, std::invalid_argument);
}

}  // namespace
}  // namespace core::simulation
