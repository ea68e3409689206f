#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "core/simulation/camera/recorded_motion.h"
#include "core/spectrum/real_fft.h"
#include "drivers/storage/flight_log.h"
#include "drivers/storage/text_file.h"
#include "tests/support/measured_data.h"

// Hover of a DJI Phantom 4 RTK.
namespace {

using core::simulation::FlightUse;
using core::simulation::make_recorded_motion;
using core::simulation::RecordedPath;

constexpr const char* kFlight = "phantom4_hover/flight_10hz.csv";
constexpr const char* kImu = "phantom4_hover/imu1_120hz_from_180s.csv";

std::string path_of(const char* file) { return (tests::measured_data_path() / file).string(); }

double rms(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

// Share of the variance below `limit_hz`; with a Hann window, so that the record's ends add no high frequencies.
double share_below(const std::vector<double>& x, double rate_hz, double limit_hz) {
  const int n_fft = core::next_power_of_two(static_cast<int>(x.size()));
  core::RealFft fft(n_fft);
  std::vector<double> windowed(static_cast<std::size_t>(n_fft));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(x.size());
    windowed[i] = x[i] * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * share));
  }
  std::vector<std::complex<double>> spectrum(static_cast<std::size_t>(fft.n_bins()));
  fft.forward(windowed, spectrum);
  double below = 0.0, all = 0.0;
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double power = std::norm(spectrum[k]);
    all += power;
    if (static_cast<double>(k) * rate_hz / n_fft < limit_hz) below += power;
  }
  return below / all;
}

TEST(RecordedFlight, HoverHasTheKnownDrift) {
  SKIP_WITHOUT_MEASURED(kFlight);
  const core::FlightPath path = drivers::read_flight_path(path_of(kFlight), 360.7, 440.0);
  EXPECT_NEAR(path.rate_hz, 10.0, 1e-6);
  EXPECT_EQ(path.n_samples(), 794U);
  const double north_m = 1e-3 * rms(path.north_mm), east_m = 1e-3 * rms(path.east_mm), up_m = 1e-3 * rms(path.up_mm);
  const double north_share = share_below(path.north_mm, path.rate_hz, 0.5);
  const double east_share = share_below(path.east_mm, path.rate_hz, 0.5);
  fmt::print(
      "north {:.4f} m rms, {:.2f} % below 0.5 Hz; east {:.4f} m, {:.2f} %; up {:.4f} m; heading {:.1f} degrees\n",
      north_m, 100.0 * north_share, east_m, 100.0 * east_share, up_m, path.mean_heading_deg);
  EXPECT_NEAR(north_m, 0.117, 0.02 * 0.117);
  EXPECT_NEAR(east_m, 0.084, 0.02 * 0.084);
  EXPECT_GE(north_share, 0.98);
  EXPECT_GE(east_share, 0.98);
}

TEST(RecordedFlight, CameraFacingTheMeanHeadingKeepsTheVariance) {
  SKIP_WITHOUT_MEASURED(kFlight);
  const core::FlightPath path = drivers::read_flight_path(path_of(kFlight), 360.7, 440.0);
  const RecordedPath motion(make_recorded_motion(path, nullptr, {path.mean_heading_deg, 0.0, 0.0}));
  EXPECT_NEAR(std::hypot(motion.rms()[0], motion.rms()[2]), std::hypot(rms(path.north_mm), rms(path.east_mm)), 1e-6);
  EXPECT_NEAR(motion.duration_s(), 79.3, 1e-6);
  // Longer than the record: no jump where its direction reverses.
  for (double t = 79.0; t < 79.6; t += 0.01) {
    for (const int axis : {0, 1, 2}) EXPECT_LT(std::abs(motion.at(axis, t + 0.01) - motion.at(axis, t)), 10.0);
  }
}

TEST(RecordedFlight, InertialSensorCoversOnlyTheBeginningOfTheHoverAndSaysSo) {
  SKIP_WITHOUT_MEASURED(kImu);
  try {
    (void)drivers::read_flight_attitude(path_of(kImu), 180.5, 360.7, 440.0);
    FAIL() << "accepted";
  } catch (const drivers::FileError& e) {
    EXPECT_NE(std::string(e.what()).find("only 360.7 to 371.3"), std::string::npos) << e.what();
  }
}

TEST(RecordedFlight, TenSecondsOfHoverWithAttitudeAndVibration) {
  SKIP_WITHOUT_MEASURED(kImu);
  const core::FlightPath path = drivers::read_flight_path(path_of(kFlight), 360.7, 371.0);
  const core::FlightAttitude attitude = drivers::read_flight_attitude(path_of(kImu), 180.5, 360.7, 371.2);
  EXPECT_NEAR(attitude.rate_hz, 120.0, 0.05);
  const double roll_deg = rms(attitude.roll_rad) * 180.0 / std::numbers::pi;
  const double pitch_deg = rms(attitude.pitch_rad) * 180.0 / std::numbers::pi;
  const RecordedPath calm(make_recorded_motion(path, &attitude, {path.mean_heading_deg, 0.02, 0.0}));
  const RecordedPath shaken(make_recorded_motion(path, &attitude, {path.mean_heading_deg, 0.02, 2.0}));
  double sum = 0.0;
  for (double t = 2.0; t < 8.0; t += 0.004) sum += std::pow(shaken.at(0, t) - calm.at(0, t), 2) * 0.004 / 6.0;
  fmt::print("roll {:.2f}, pitch {:.2f} degrees rms; sideways vibration above 2 Hz {:.2f} mm rms\n", roll_deg,
             pitch_deg, std::sqrt(sum));
  EXPECT_GT(roll_deg, 0.2);
  EXPECT_LT(roll_deg, 3.0);
  EXPECT_NEAR(shaken.rms()[5], 0.02 * rms(attitude.roll_rad), 0.1 * 0.02 * rms(attitude.roll_rad));
  EXPECT_GT(std::sqrt(sum), 0.01);
  EXPECT_LT(std::sqrt(sum), 20.0);
}

}  // namespace
