#include "drivers/storage/calibration_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core/persistence.hpp>
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
  EXPECT_EQ(c.camera.fx, 461.629);
  EXPECT_EQ(c.camera.fy, 460.152);
  EXPECT_EQ(c.camera.cx, 362.680);
  EXPECT_EQ(c.camera.cy, 246.049);
  EXPECT_EQ(c.width_px, 752);
  EXPECT_EQ(c.height_px, 480);
  EXPECT_EQ(c.camera.lens, core::LensModel::kRadialTangential);
  EXPECT_THAT(c.camera.distortion, ElementsAre(-0.2917, 0.0801, -0.0003, 0.0001, 0, 0, 0, 0));
}

TEST(CalibrationFile, ReadsOpencv) {
  const Calibration c = parse_calibration(kOpencv, "c.yaml");
  EXPECT_EQ(c.camera.fx, 650.0);
  EXPECT_EQ(c.camera.fy, 660.0);
  EXPECT_EQ(c.camera.cx, 320.0);
  EXPECT_EQ(c.camera.cy, 240.0);
  EXPECT_EQ(c.width_px, 640);
  EXPECT_THAT(c.camera.distortion, ElementsAre(-0.41, 0.2, 0.0, 0.0, -0.05, 0, 0, 0));
  EXPECT_EQ(c.rms_px, 0.34);
}

TEST(CalibrationFile, ReadsRos) {
  const Calibration c = parse_calibration(kRos, "c.yaml");
  EXPECT_EQ(c.camera.fx, 900.0);
  EXPECT_EQ(c.camera.fy, 901.0);
  EXPECT_EQ(c.camera.cy, 360.0);
  EXPECT_EQ(c.height_px, 720);
  EXPECT_THAT(c.camera.distortion, ElementsAre(0.1, -0.2, 0.001, 0.002, 0.0, 0, 0, 0));
}

TEST(CalibrationFile, LeavesUnknownSizeZero) {
  EXPECT_EQ(parse_calibration(replaced(kKalibr, "  resolution: [752, 480]\n", ""), "c.yaml").width_px, 0);
}

TEST(CalibrationFile, ReadsKalibrsEquidistant) {
  const Calibration c = parse_calibration(replaced(kKalibr, "radtan", "equidistant"), "c.yaml");
  EXPECT_EQ(c.camera.lens, core::LensModel::kEquidistant);
  EXPECT_THAT(c.camera.distortion, ElementsAre(-0.2917, 0.0801, -0.0003, 0.0001, 0, 0, 0, 0));
}

TEST(CalibrationFile, ReadsKalibrWithoutDistortion) {
  const std::string text = replaced(replaced(kKalibr, "radtan", "none"), "[-0.2917, 0.0801, -0.0003, 0.0001]", "[]");
  EXPECT_FALSE(parse_calibration(text, "c.yaml").camera.distorts());
  EXPECT_THAT(refusal(replaced(kKalibr, "radtan", "none")), HasSubstr("coefficients with distortion_model `none`"));
}

// The flag that OpenCV's own calibration sample writes for its fisheye model.
TEST(CalibrationFile, ReadsOpencvsFisheye) {
  const auto with = [](const std::string& flag) {
    return replaced(replaced(replaced(kOpencv, "image_width", flag + "image_width"), "rows: 5", "rows: 4"),
                    ", -5.0e-02", "");
  };
  EXPECT_EQ(parse_calibration(with("fisheye_model: 1\n"), "c.yaml").camera.lens, core::LensModel::kEquidistant);
  EXPECT_EQ(parse_calibration(with("fisheye_model: 0\n"), "c.yaml").camera.lens, core::LensModel::kRadialTangential);
  EXPECT_EQ(parse_calibration(with(""), "c.yaml").camera.lens, core::LensModel::kRadialTangential);
  EXPECT_THAT(refusal(replaced(kOpencv, "image_width", "fisheye_model: 1\nimage_width")),
              HasSubstr("5 numbers instead of 4 (k1 k2 k3 k4)"));
}

TEST(CalibrationFile, ReadsEverySpellingOfOpencvsKeys) {
  for (const char* matrix : {"cameraMatrix", "CameraMatrix", "K"}) {
    for (const char* coefficients : {"dist_coeffs", "distCoeffs", "D"}) {
      const std::string text =
          replaced(replaced(kOpencv, "camera_matrix", matrix), "distortion_coefficients", coefficients);
      EXPECT_EQ(parse_calibration(text, "c.yaml").camera.fx, 650.0) << matrix << ' ' << coefficients;
    }
  }
}

TEST(CalibrationFile, ReadsARosMessage) {
  const Calibration c = parse_calibration(
      "header:\n  seq: 1\nheight: 480\nwidth: 640\ndistortion_model: \"equidistant\"\nD: [0.1, 0.02, 0.003, 4e-4]\n"
      "K: [350.5, 0.0, 320.0, 0.0, 351.5, 240.0, 0.0, 0.0, 1.0]\nbinning_x: 0\n",
      "c.yaml");
  EXPECT_EQ(c.camera.lens, core::LensModel::kEquidistant);
  EXPECT_EQ(c.camera.fy, 351.5);
  EXPECT_EQ(c.height_px, 480);
}

TEST(CalibrationFile, ReadsTheRationalModel) {
  const auto with = [](const std::string& model, const std::string& cols, const std::string& data) {
    return replaced(replaced(replaced(kRos, "plumb_bob", model), "cols: 5", cols), "[0.1, -0.2, 0.001, 0.002, 0]",
                    data);
  };
  const std::string eight = "[0.1, -0.02, 0.001, 0.002, 0.3, 0.4, 0.05, 0.1]";
  const Calibration c = parse_calibration(with("rational_polynomial", "cols: 8", eight), "c.yaml");
  EXPECT_THAT(c.camera.distortion, ElementsAre(0.1, -0.02, 0.001, 0.002, 0.3, 0.4, 0.05, 0.1));
  const std::string padded = "[0.1, -0.02, 0.001, 0.002, 0.3, 0, 0, 0, 0, 0, 0, 0]";
  EXPECT_EQ(parse_calibration(with("rational_polynomial", "cols: 12", padded), "c.yaml").camera.distortion[4], 0.3);
  EXPECT_EQ(parse_calibration(with("plumb_bob", "cols: 12", padded), "c.yaml").camera.distortion[4], 0.3);
  EXPECT_THAT(refusal(with("plumb_bob", "cols: 8", eight)), HasSubstr("8 numbers instead of 4 or 5"));
  EXPECT_THAT(refusal(with("rational_polynomial", "cols: 12", replaced(padded, "0, 0]", "0.001, 0]"))),
              AllOf(HasSubstr("c.yaml:12"), HasSubstr("thin prism"), HasSubstr("calibrate without")));
}

TEST(CalibrationFile, RefusesOtherModels) {
  EXPECT_THAT(refusal(replaced(kKalibr, "radtan", "fov")),
              AllOf(HasSubstr("c.yaml:5: distortion_model: `fov` is not supported"), HasSubstr("equidistant")));
  for (const char* model : {"omni", "ds", "eucm", "equirectangular"}) {
    EXPECT_THAT(refusal(replaced(kKalibr, "pinhole", model)),
                AllOf(HasSubstr("c.yaml:3: camera_model: `" + std::string(model) + "` is not"), HasSubstr("pinhole")));
  }
  EXPECT_THAT(refusal(replaced(kRos, "plumb_bob", "double_sphere")), HasSubstr("c.yaml:8: distortion_model"));
  EXPECT_THAT(refusal(std::string(kKalibr) + replaced(kKalibr, "cam0", "cam1")),
              AllOf(HasSubstr("c.yaml:12"), HasSubstr("second camera")));
}

TEST(CalibrationFile, RefusesACameraThatCannotBeThatOfTheImage) {
  EXPECT_THAT(refusal(replaced(kKalibr, "362.680", "762.680")),
              AllOf(HasSubstr("c.yaml:6: principal point (762.68, 246.049) is refused"), HasSubstr("752 x 480 px")));
  EXPECT_THAT(refusal(replaced(kRos, "640, 0, 901", "-3, 0, 901")), HasSubstr("principal point (-3, 360)"));
  // r (1 - 1.2 r^2) falls beyond r = 0.527, at 0.351 focal lengths in the picture: 316 px.
  EXPECT_THAT(refusal(replaced(kRos, "[0.1, -0.2, 0.001, 0.002, 0]", "[-1.2, 0, 0, 0, 0]")),
              AllOf(HasSubstr("c.yaml:7: the distortion folds the image: 316 px from the principal point"),
                    HasSubstr("28 degrees off the axis"), HasSubstr("calibrate with")));
  EXPECT_EQ(refusal(replaced(replaced(kRos, "[0.1, -0.2, 0.001, 0.002, 0]", "[-1.2, 0, 0, 0, 0]"),
                             "image_width: 1280\n", "")),
            "");  // the size of the image is not known yet
}

TEST(CalibrationFile, SaysWhatScalingWouldGive) {
  const core::CameraModel half = scaled_camera(parse_calibration(kRos, "c.yaml"), 640);
  EXPECT_EQ(half.fx, 450.0);
  EXPECT_EQ(half.cx, 319.75);  // the left edge stays at -0.5
  EXPECT_EQ(half.distortion[0], 0.1);
}

TEST(CalibrationFile, ReadsBackWhatItWrites) {
  const core::CameraModel cameras[] = {
      {1.0 / 3.0 + 900.0, 901.25, 640.1, 360.2, {-0.1, 1.0 / 7.0, 1e-5, -2e-4, -0.03}},
      {900.0, 901.25, 640.1, 360.2, {-0.1, 0.02, 1e-5, -2e-4, 0.001, 0.1, 0.01, 0.001}},
      {500.0, 501.0, 640.1, 360.2, {-0.01, 0.02, -1e-5, -2e-4}, core::LensModel::kEquidistant}};
  for (const core::CameraModel& camera : cameras) {
    const Calibration written{camera, 1280, 720, 0.123};
    const Calibration c = parse_calibration(calibration_text(written, {9, 6, 25.0, 12, {0.1, 0.2}}), "c.yaml");
    EXPECT_EQ(c.camera.fx, camera.fx);
    EXPECT_EQ(c.camera.cy, camera.cy);
    EXPECT_EQ(c.camera.distortion, camera.distortion);
    EXPECT_EQ(c.camera.lens, camera.lens);
    EXPECT_EQ(c.width_px, 1280);
    EXPECT_EQ(c.height_px, 720);
    EXPECT_EQ(c.rms_px, 0.123);
  }
}

TEST(CalibrationFile, OpencvReadsWhatItWrites) {
  const core::CameraModel camera{
      500.25, 501.0, 640.1, 360.2, {-0.01, 0.02, -1e-5, -2e-4}, core::LensModel::kEquidistant};
  const std::string text = calibration_text({camera, 1280, 720, 0.25}, {9, 6, 25.0, 12, {0.1, 0.2}});
  const cv::FileStorage file(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
  cv::Mat matrix, coefficients;
  file["camera_matrix"] >> matrix;
  file["distortion_coefficients"] >> coefficients;
  ASSERT_EQ(matrix.size(), cv::Size(3, 3));
  EXPECT_EQ(matrix.at<double>(0, 0), 500.25);
  EXPECT_EQ(matrix.at<double>(1, 2), 360.2);
  ASSERT_EQ(coefficients.total(), 4U);
  EXPECT_EQ(coefficients.at<double>(3), -2e-4);
  EXPECT_EQ(static_cast<int>(file["image_width"]), 1280);
  EXPECT_EQ(static_cast<int>(file["fisheye_model"]), 1);
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
  // Cut after each line: the remainder is refused or complete, never a partial camera.
  const std::string ours = calibration_text(
      {{500.0, 501.0, 640.1, 360.2, {-0.01, 0.02, -1e-5, -2e-4}, core::LensModel::kEquidistant}, 1280, 720, 0.1},
      {9, 6, 25.0, 12, {0.1, 0.2}});
  for (const std::string& text : {std::string(kKalibr), std::string(kOpencv), std::string(kRos), ours}) {
    const Calibration whole = parse_calibration(text, "c.yaml");
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
      try {
        const Calibration part = parse_calibration(text.substr(0, at + 1), "c.yaml");
        EXPECT_EQ(part.camera.fx, whole.camera.fx);
        EXPECT_EQ(part.camera.distortion, whole.camera.distortion) << text.substr(0, at);
        EXPECT_EQ(part.camera.lens, whole.camera.lens) << text.substr(0, at);
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
