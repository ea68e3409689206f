#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "firmware_app/report/modal_json.h"
#include "tests/support/measured_data.h"
#include "tests/support/places.h"

// The identification of public records, as by `hovermodal identify`: only rate, quantity, highest frequency and
// input are given. tools/figures/identification_measured.sh prints the errors.
namespace {

namespace fs = std::filesystem;

core::ModalEstimate identify(const std::string& arguments) {
  const fs::path folder = fs::path(testing::TempDir()) / "measured_identification" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  const std::string command =
      tests::program("hovermodal") + " identify " + arguments + " --report " + folder.string() + " >/dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return app::read_modal_json((folder / "modal.json").string()).estimate;
}

std::string data(const char* file) { return (tests::measured_data_path() / file).string(); }

// Relative error of the mode nearest to a frequency.
double error_at(const core::ModalEstimate& estimate, double frequency_hz) {
  double best = 1.0;
  for (const core::Mode& mode : estimate.modes) {
    const double error = mode.frequency_hz / frequency_hz - 1.0;
    if (std::abs(error) < std::abs(best)) best = error;
  }
  return best;
}

std::ptrdiff_t modes_below(const core::ModalEstimate& estimate, double frequency_hz) {
  return std::count_if(estimate.modes.begin(), estimate.modes.end(),
                       [&](const core::Mode& mode) { return mode.frequency_hz < frequency_hz; });
}

const std::vector<double> kFiveStoreys{1.229, 1.436, 2.100, 4.017, 4.769, 6.683, 7.614, 9.664};
constexpr const char* kFiveStoreysSaid = " --rate 256 --channels 1 2 3 4 5 --max-frequency 12";

TEST(MeasuredIdentification, EachSetupOfTheFiveStoreyFrameAlone) {
  for (const char* setup : {"01", "04", "07", "10"}) {
    const std::string file = std::string("five_storey_frame/setup_") + setup + ".csv";
    SKIP_WITHOUT_MEASURED(file);
    SCOPED_TRACE(setup);
    const core::ModalEstimate estimate = identify("--series " + data(file.c_str()) + kFiveStoreysSaid);
    for (std::size_t k = 0; k < kFiveStoreys.size(); ++k)
      EXPECT_LE(std::abs(error_at(estimate, kFiveStoreys[k])), k < 2 ? 0.0025 : 0.0010) << kFiveStoreys[k];
    EXPECT_EQ(modes_below(estimate, 10.0), 8);
  }
}

TEST(MeasuredIdentification, TheFiveStoreyFrameMerged) {
  SKIP_WITHOUT_MEASURED("five_storey_frame/setup_01.csv");
  std::string files;
  for (const char* setup : {"01", "04", "07", "10"})
    files += " " + data((std::string("five_storey_frame/setup_") + setup + ".csv").c_str());
  const core::ModalEstimate estimate =
      identify("--series" + files + kFiveStoreysSaid + " --reference ref_x_m_s2 ref_y_m_s2 --merge");
  std::vector<double> errors;
  for (const double f : kFiveStoreys) errors.push_back(std::abs(error_at(estimate, f)));
  std::sort(errors.begin(), errors.end());
  EXPECT_LE(errors.back(), 0.0010);
  EXPECT_LE(0.5 * (errors[3] + errors[4]), 0.0003);
  EXPECT_EQ(modes_below(estimate, 10.0), 8);
  for (const core::Mode& mode : estimate.modes) {
    EXPECT_EQ(mode.shape.size(), 2U + 4U * 3U);
    EXPECT_GT(mode.mpc, 0.95) << mode.frequency_hz;
  }
}

TEST(MeasuredIdentification, FiveDegreesOfFreedom) {
  SKIP_WITHOUT_MEASURED("five_dof_example/accelerations.csv");
  const core::ModalEstimate estimate =
      identify("--series " + data("five_dof_example/accelerations.csv") + " --rate 100 --max-frequency 10");
  const std::vector<double> truth{0.890, 2.598, 4.095, 5.261, 6.000};
  const std::vector<double> damping_bar{0.30, 0.20, 0.15, 0.15, 0.15};
  ASSERT_EQ(estimate.modes.size(), truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_NEAR(estimate.modes[k].frequency_hz / truth[k], 1.0, 0.0025) << truth[k];
    EXPECT_NEAR(estimate.modes[k].damping_ratio / 0.02, 1.0, damping_bar[k]) << truth[k];
  }
}

TEST(MeasuredIdentification, PublishedShearFrame) {
  SKIP_WITHOUT_MEASURED("published_shear_frame/accelerations.csv");
  const core::ModalEstimate estimate =
      identify("--series " + data("published_shear_frame/accelerations.csv") + " --quantity a --max-frequency 2");
  const std::vector<double> own_rad_s{1.1364, 3.2968, 5.1494, 6.5562, 7.4406};
  ASSERT_EQ(estimate.modes.size(), own_rad_s.size());
  for (std::size_t k = 0; k < own_rad_s.size(); ++k)
    EXPECT_NEAR(estimate.modes[k].frequency_hz * 2.0 * std::numbers::pi / own_rad_s[k], 1.0, k == 0 ? 0.0035 : 0.0015);
}

TEST(MeasuredIdentification, AnEarthquakesPeaksAreNoModes) {
  SKIP_WITHOUT_MEASURED("mini_shake_table/flexible_northridge.csv");
  const core::ModalEstimate estimate = identify("--series " + data("mini_shake_table/flexible_northridge.csv") +
                                                " --input ground_m_s2 --max-frequency 24");
  ASSERT_EQ(estimate.modes.size(), 3U);
  EXPECT_NEAR(estimate.modes[0].frequency_hz / 3.69, 1.0, 0.01);
  EXPECT_NEAR(estimate.modes[1].frequency_hz / 11.13, 1.0, 0.01);
  EXPECT_NEAR(estimate.modes[2].frequency_hz / 16.58, 1.0, 0.01);
  EXPECT_TRUE(std::any_of(estimate.rejected.begin(), estimate.rejected.end(),
                          [](const core::Mode& mode) { return mode.verdict == core::Verdict::kInputPeak; }));
}

TEST(MeasuredIdentification, AFilmedBeamAgreesWithItsAccelerometer) {
  SKIP_WITHOUT_MEASURED("ladisk_beam/camera_displacements_um.csv");
  const core::ModalEstimate camera =
      identify("--series " + data("ladisk_beam/camera_displacements_um.csv") + " --max-frequency 2500");
  EXPECT_LE(std::abs(error_at(camera, 695.6)), 0.003);
  EXPECT_LE(std::abs(error_at(camera, 1897.9)), 0.003);
  SKIP_WITHOUT_MEASURED("ladisk_beam/accelerometer_and_force.lvm");
  const core::ModalEstimate accelerometer = identify("--series " + data("ladisk_beam/accelerometer_and_force.lvm") +
                                                     " --channels 'Acceleration (Trigger)' --max-frequency 2500");
  EXPECT_LE(std::abs(error_at(accelerometer, 695.6)), 0.003);
  EXPECT_LE(std::abs(error_at(accelerometer, 1897.9)), 0.003);
}

}  // namespace
