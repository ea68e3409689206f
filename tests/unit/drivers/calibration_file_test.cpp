#include "drivers/storage/calibration_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kKalibr = R"(cam0:
  cam_overlaps: []
  camera_model: pinhole
  distortion_coeffs: [-0.2917, 0.0801, -0.0003, 0.0001]
  distortion_model: radtan
  intrinsics: [461.629, 460.152, 362.680, 246.049]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
  T_cam_imu:
  - [0.01, -0.99, 0.0, 0.02]
  - [0.0, 0.0, 0.0, 1.0]
)";

constexpr const char* kOpencv = R"(%YAML:1.0
---
calibration_time: "Tue Mar  5 10:11:12 2024"
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 6.5e+02, 0., 3.2e+02, 0., 6.6e+02,
       2.4e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -4.1e-01, 2.0e-01, 0., 0., -5.0e-02 ]
avg_reprojection_error: 3.4e-01
)";

constexpr const char* kRos = R"(image_width: 1280
image_height: 720
camera_name: head
camera_matrix:
  rows: 3
  cols: 3
  data: [900, 0, 640, 0, 901, 360, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.1, -0.2, 0.001, 0.002, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    static_cast<void>(parse_calibration(text, "c.yaml"));
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(CalibrationFile, ReadsKalibr) {
  const Calibration c = parse_calibration(kKalibr, "c.yaml");
  EXPECT_EQ(c.fx, 461.629);
  EXPECT_EQ(c.fy, 460.152);
  EXPECT_EQ(c.cx, 362.680);
  EXPECT_EQ(c.cy, 246.049);
  EXPECT_EQ(c.width_px, 752);
  EXPECT_EQ(c.height_px, 480);
  EXPECT_EQ(c.model, "pinhole-radtan");
  EXPECT_THAT(c.distortion, ElementsAre(-0.2917, 0.0801, -0.0003, 0.0001));
}

TEST(CalibrationFile, ReadsOpencv) {
  const Calibration c = parse_calibration(kOpencv, "c.yaml");
  EXPECT_EQ(c.fx, 650.0);
  EXPECT_EQ(c.fy, 660.0);
  EXPECT_EQ(c.cx, 320.0);
  EXPECT_EQ(c.cy, 240.0);
  EXPECT_EQ(c.width_px, 640);
  EXPECT_THAT(c.distortion, ElementsAre(-0.41, 0.2, 0.0, 0.0, -0.05));
}

TEST(CalibrationFile, ReadsRos) {
  const Calibration c = parse_calibration(kRos, "c.yaml");
  EXPECT_EQ(c.fx, 900.0);
  EXPECT_EQ(c.fy, 901.0);
  EXPECT_EQ(c.cy, 360.0);
  EXPECT_EQ(c.height_px, 720);
  EXPECT_THAT(c.distortion, ElementsAre(0.1, -0.2, 0.001, 0.002, 0.0));
}

TEST(CalibrationFile, LeavesUnknownSizeZero) {
  EXPECT_EQ(parse_calibration(replaced(kKalibr, "  resolution: [752, 480]\n", ""), "c.yaml").width_px, 0);
}

TEST(CalibrationFile, TakesHigherCoefficientsOnlyAsZeros) {
  const auto with = [](const std::string& data) {
    return replaced(replaced(kRos, "cols: 5", "cols: 8"), "[0.1, -0.2, 0.001, 0.002, 0]", data);
  };
  EXPECT_EQ(parse_calibration(with("[0.1, -0.2, 0.001, 0.002, 0.3, 0, 0, 0]"), "c.yaml").distortion.size(), 5U);
  EXPECT_THAT(refusal(with("[0.1, -0.2, 0.001, 0.002, 0.3, 0, 0, 0.1]")), HasSubstr("8 numbers instead of 4 or 5"));
}

TEST(CalibrationFile, RefusesOtherModels) {
  EXPECT_THAT(refusal(replaced(kKalibr, "radtan", "equidistant")),
              AllOf(HasSubstr("c.yaml:5"), HasSubstr("`equidistant` is not supported"), HasSubstr("radtan")));
  EXPECT_THAT(refusal(replaced(kKalibr, "pinhole", "omni")), HasSubstr("`omni` is not supported"));
  EXPECT_THAT(refusal(replaced(kRos, "plumb_bob", "equidistant")), HasSubstr("not supported"));
  EXPECT_THAT(refusal(replaced(kOpencv, "image_width", "fisheye_model: 1\nimage_width")), HasSubstr("fisheye"));
  EXPECT_THAT(refusal(std::string(kKalibr) + replaced(kKalibr, "cam0", "cam1")),
              AllOf(HasSubstr("c.yaml:12"), HasSubstr("second camera")));
}

TEST(CalibrationFile, RefusesBrokenNumbers) {
  EXPECT_THAT(refusal(replaced(kKalibr, "461.629", ".nan")), AllOf(HasSubstr("c.yaml:6"), HasSubstr("intrinsics")));
  EXPECT_THAT(refusal(replaced(kKalibr, "461.629", "-461")), HasSubstr("focal length -461"));
  EXPECT_THAT(refusal(replaced(kKalibr, "461.629, ", "")), HasSubstr("3 numbers instead of 4"));
  EXPECT_THAT(refusal(replaced(kKalibr, "0.0801, ", "")), HasSubstr("3 numbers instead of 4 or 5"));
  EXPECT_THAT(refusal(replaced(kKalibr, "[752, 480]", "[752]")), HasSubstr("resolution"));
  EXPECT_THAT(refusal(replaced(kKalibr, "[752, 480]", "[0, 480]")), HasSubstr("resolution"));
  EXPECT_THAT(refusal(replaced(kOpencv, "6.5e+02", ".Inf")), HasSubstr("camera_matrix"));
  EXPECT_THAT(refusal(replaced(kOpencv, "0., 3.2e+02", "3.2e+02")), HasSubstr("8 numbers instead of rows x cols = 9"));
  EXPECT_THAT(refusal(replaced(kOpencv, "-5.0e-02", "-5.0e+02")), HasSubstr("-100 .. 100"));
  EXPECT_THAT(refusal(replaced(kRos, "[900, 0, 640", "[900, 5, 640")), HasSubstr("not of the form"));
}

TEST(CalibrationFile, RefusesFilesThatAreCutOff) {
  // Cut after each line: whatever is left is refused or complete, never half a camera.
  for (const std::string text : {kKalibr, kOpencv, kRos}) {
    const Calibration whole = parse_calibration(text, "c.yaml");
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
      try {
        const Calibration part = parse_calibration(text.substr(0, at + 1), "c.yaml");
        EXPECT_EQ(part.fx, whole.fx);
        EXPECT_EQ(part.distortion, whole.distortion) << text.substr(0, at);
      } catch (const FileError&) {
      }
    }
  }
  EXPECT_THAT(refusal("cam0:\n  camera_model: pinhole\n"), HasSubstr("no calibration"));
  EXPECT_FALSE(refusal("").empty());
  EXPECT_THROW(static_cast<void>(read_calibration("/nonexistent.yaml")), FileError);
}

}  // namespace
}  // namespace drivers
