#include "drivers/storage/attitude_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "drivers/storage/text_file.h"
#include "tests/support/folder_test.h"

namespace {

using ::testing::HasSubstr;

class AttitudeFile : public tests::FolderTest {
 protected:
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      (void)drivers::read_attitude_csv(file(text));
    } catch (const drivers::FileError& error) {
      return error.what();
    }
    return "no refusal";
  }
};

TEST_F(AttitudeFile, ReadsAnglesAndQuaternionsInTheUnitsOfTheHeader) {
  const auto degrees = drivers::read_attitude_csv(
      file("# of an autopilot\nt_ms,yaw_deg,roll_deg,pitch_deg,note\n0,90,0,0,a\n20,0,0,60,b\n"));
  ASSERT_EQ(degrees.size(), 2U);
  EXPECT_DOUBLE_EQ(degrees[1].t_s, 0.02);
  EXPECT_NEAR(degrees[0].wxyz[0], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(degrees[0].wxyz[3], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(degrees[1].wxyz[2], 0.5, 1e-12);
  const auto quaternions = drivers::read_attitude_csv(file("qw,qx,qy,qz,t_us\n1,0,0,0,5\n0,2,0,0,6\n"));
  EXPECT_DOUBLE_EQ(quaternions[1].wxyz[1], 2.0);
  EXPECT_DOUBLE_EQ(quaternions[0].t_s, 5e-6);
}

TEST_F(AttitudeFile, NamesFileLineAndColumnOfWhatIsWrong) {
  const std::string head = "t_s,roll_deg,pitch_deg,yaw_deg\n0,1,2,3\n";
  EXPECT_THAT(refusal(head + "1,1,x,3\n"), HasSubstr("a.csv:3: column 3 (pitch_deg): \"x\" is no number"));
  EXPECT_THAT(refusal(head + "1,1,nan,3\n"), HasSubstr("column 3 (pitch_deg)"));
  EXPECT_THAT(refusal(head + "1,1,2\n"), HasSubstr("column 4 (yaw_deg) is missing"));
  EXPECT_THAT(refusal(head + "0,1,2,3\n"), HasSubstr("column 1 (t_s): time 0 s does not go on"));
  EXPECT_THAT(refusal(head), HasSubstr("fewer than two"));
  EXPECT_THAT(refusal(""), HasSubstr("fewer than two"));
  EXPECT_THAT(refusal("t,roll_deg,pitch_deg,yaw_deg\n"), HasSubstr("name it t_s"));
  EXPECT_THAT(refusal("t_s,roll,pitch,yaw\n"), HasSubstr("name its columns roll_deg"));
  EXPECT_THAT(refusal("t_s,qw,qx,qy,qz\n0,0,0,0,0\n"), HasSubstr("a.csv:2: column 2 (qw)"));
}

}  // namespace
