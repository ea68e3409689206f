#include "drivers/storage/motors_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "drivers/storage/text_file.h"
#include "tests/support/folder_test.h"

namespace {

class MotorsFile : public tests::FolderTest {
 protected:
  [[nodiscard]] std::string error(const std::string& text) const {
    try {
      (void)drivers::read_motors_csv(file(text));
    } catch (const drivers::FileError& refused) {
      return refused.what();
    }
    return "";
  }
};

// Spinning up and down takes a tenth of the record each.
TEST_F(MotorsFile, MedianAndSpreadLeaveTakeOffAndLandingOut) {
  std::string text = "# of a flight\nt_s,volts,motor,hz\n";
  for (int i = 0; i < 100; ++i) {
    const double hz = i < 10    ? 3.0 * i
                      : i >= 90 ? 3.0 * (99 - i)
                                : 95.0 + 0.1 * std::numbers::sqrt2 * std::sin(2.4 * i);
    text += std::to_string(i) + ",16.1,2," + std::to_string(hz) + "\n" + std::to_string(i) + ",16.1,4,0\n";
  }
  const auto motors = drivers::read_motors_csv(file(text));
  ASSERT_EQ(motors.size(), 1U) << "motor 4 stands";
  EXPECT_EQ(motors[0].number, 2);
  EXPECT_NEAR(motors[0].hz, 95.0, 0.08);
  EXPECT_NEAR(motors[0].spread_hz, 0.1, 0.08);
}

TEST_F(MotorsFile, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_NE(error("t_s,motor,rpm\n1,1,95\n").find(":1: no column hz"), std::string::npos);
  EXPECT_NE(error("t_s,motor,hz\n1,1,fast\n").find(":2: column 3 (hz)"), std::string::npos);
  EXPECT_NE(error("t_s,motor,hz\n1,1\n").find(":2: column 3 (hz) is missing"), std::string::npos);
  EXPECT_NE(error("t_s,motor,hz\n1,0,95\n").find(":2: column 2 (motor)"), std::string::npos);
  EXPECT_NE(error("t_s,motor,hz\n1,1,nan\n").find(":2: column 3 (hz)"), std::string::npos);
  EXPECT_NE(error("t_s,motor,hz\n1,1,0\n").find("no motor turns"), std::string::npos);
  EXPECT_NE(error("").find("no motor turns"), std::string::npos);
}

}  // namespace
