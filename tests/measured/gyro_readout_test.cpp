#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "tests/support/command.h"
#include "tests/support/measured_data.h"

namespace {

// 102 hand-held frames of a phone beside its gyro. Frame file N goes with line N - 1 of the stamps; the first is 99.
TEST(MeasuredPhone, ItsReadoutTimeExplainsHowThePictureMoves) {
  SKIP_WITHOUT_MEASURED("phone_rolling_shutter_gyro/gyro.txt");
  const std::string folder = (tests::measured_data_path() / "phone_rolling_shutter_gyro").string();
  const tests::Outcome outcome =
      tests::run("hovermodal", "readout --clip '" + folder + "/frames' --stamps '" + folder +
                                   "/framestamp.txt' --gyro '" + folder + "/gyro.txt' --first-stamp 98");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  std::map<std::string, std::pair<double, double>> values;
  std::istringstream lines(outcome.text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::string name;
    cells >> name;
    cells >> values[name].first >> values[name].second;
  }
  const auto [readout_ms, std_ms] = values["readout_ms"];
  EXPECT_GT(readout_ms, 5.0 * std_ms);
  EXPECT_LT(readout_ms, 33.4);  // a frame
  const auto [without_px, with_px] = values["held_out_rms_px"];
  EXPECT_GT(with_px, 0.0);
  EXPECT_LT(with_px, 0.7 * without_px);
}

}  // namespace
