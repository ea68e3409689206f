#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "drivers/storage/calibration_file.h"
#include "drivers/storage/yaml.h"
#include "tests/support/answers.h"
#include "tests/support/board_image.h"
#include "tests/support/command.h"
#include "tests/support/folder_test.h"
#include "tests/support/xml_fault.h"

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Lens = core::simulation::LensParameters;

class Calibrate : public tests::FolderTest {
 protected:
  // Frames of a board of 9 x 6 corners at `poses`, as images.
  void paint(const tests::DrawnCamera& camera, const std::vector<tests::DrawnPose>& poses) {
    const tests::BoardPainter painter(camera);
    std::filesystem::create_directories(folder_ / "frames");
    for (std::size_t i = 0; i < poses.size(); ++i) {
      cv::imwrite((folder_ / "frames" / ("f" + std::to_string(i) + ".png")).string(),
                  painter.paint(board_, poses[i], 2.0, static_cast<unsigned>(i) + 1));
    }
  }
  [[nodiscard]] tests::Outcome calibrate(const std::string& arguments, const std::string& sources = "frames") const {
    return tests::run("hovermodal", "calibrate " + (folder_ / sources).string() + " --board 9x6 --square-mm 25 --out " +
                                        out() + " " + arguments);
  }
  [[nodiscard]] std::string out() const { return (folder_ / "calibration.yaml").string(); }
  [[nodiscard]] std::vector<double> sigma() const {
    std::string text = tests::read(out());
    text.erase(0, text.find('\n'));
    const drivers::YamlNode root = drivers::parse_yaml(text, "c");
    std::vector<double> values;
    for (const auto& item : root.find("standard_deviations")->find("data")->items)
      values.push_back(std::stod(item.text));
    return values;
  }
  // Within four of the stated deviations each: nine at once lie beyond by chance once in two thousand runs.
  void expect_truth(const tests::DrawnCamera& truth, int n_coefficients) const {
    const core::CameraModel c = drivers::read_calibration(out()).camera;
    const std::vector<double> s = sigma();
    EXPECT_NEAR(c.fx, truth.fx, 4.0 * s[0]);
    EXPECT_NEAR(c.fy, truth.fy, 4.0 * s[1]);
    EXPECT_NEAR(c.cx, truth.cx, 4.0 * s[2]);
    EXPECT_NEAR(c.cy, truth.cy, 4.0 * s[3]);
    EXPECT_LT(s[0], 0.005 * truth.fx);  // a deviation that allows anything would pass too
    EXPECT_LT(s[2], 2.0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(n_coefficients); ++i)
      EXPECT_NEAR(c.distortion[i], truth.lens.k[i], 4.0 * s[4 + i]) << i;
  }

  core::ChessBoard board_;
};

TEST_F(Calibrate, FindsALensFromDrawnFrames) {
  tests::DrawnCamera camera;
  camera.lens = {Lens::Model::kRadialTangential, {-0.28, 0.09, 1e-3, -8e-4, 0.0}};
  paint(camera, tests::spread_poses(board_, camera, 16));
  const tests::Outcome outcome = calibrate("--report " + (folder_ / "report").string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("reprojection error"), HasSubstr("worst view"), HasSubstr("per ninth"),
                                  HasSubstr("standard deviation")));
  expect_truth(camera, 5);
  const drivers::Calibration file = drivers::read_calibration(out());
  EXPECT_EQ(file.width_px, 640);
  EXPECT_GT(file.rms_px, 0.0);
  EXPECT_LT(file.rms_px, 0.15);
  const std::string svg = tests::read(folder_ / "report" / "calibration.svg");
  EXPECT_EQ(test_support::xml_fault(svg), "");
  EXPECT_THAT(svg, HasSubstr("reprojection error"));
}

TEST_F(Calibrate, PrintsTheCameraAsJsonAndReplacesAFileOnlyWithForce) {
  const tests::DrawnCamera camera;
  paint(camera, tests::spread_poses(board_, camera, 8));
  const std::string command =
      "calibrate " + (folder_ / "frames").string() + " --board 9x6 --square-mm 25 --out " + out();
  const nlohmann::json told = tests::expect_answers(command + " --force");
  const core::CameraModel file = drivers::read_calibration(out()).camera;
  EXPECT_NEAR(told["parameters"]["fx"]["value"].get<double>(), file.fx, 1e-6 * file.fx);
  EXPECT_NEAR(told["parameters"]["fx"]["sigma"].get<double>(), sigma()[0], 1e-3 * sigma()[0]);
  EXPECT_EQ(told["parameters"].size(), 9U);
  EXPECT_EQ(told["views"], 8);
  const std::string before = tests::read(out());
  const tests::Streams again = tests::run_apart(command);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr(out() + ": exists; name another file, or --force"));
  EXPECT_EQ(tests::read(out()), before);
}

TEST_F(Calibrate, FindsAFisheyeFromDrawnFrames) {
  tests::DrawnCamera camera{640, 480, 300.0, 301.0, 322.3, 238.1, {Lens::Model::kEquidistant, {0.03, -0.01, 0.0, 0.0}}};
  paint(camera, tests::spread_poses(board_, camera, 16));
  const tests::Outcome outcome = calibrate("--model equidistant");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_EQ(drivers::read_calibration(out()).camera.lens, core::LensModel::kEquidistant);
  expect_truth(camera, 4);
}

TEST_F(Calibrate, WarnsWhenTheBoardAlwaysFacesTheCamera) {
  const tests::DrawnCamera camera;
  std::vector<tests::DrawnPose> poses;
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d middle(-30.0 + 30.0 * (i % 3), -20.0 + 40.0 * static_cast<double>(i / 3), 400.0 + 10.0 * i);
    poses.push_back(tests::board_pose(board_, middle, i % 2 == 0 ? 4.0 : -4.0, 3.0, 5.0 * i));
  }
  paint(camera, poses);
  const tests::Outcome outcome = calibrate("");
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("faces the camera"), HasSubstr("only 6 views")));
}

TEST_F(Calibrate, SaysWhenSquaresWereCountedForCorners) {
  const tests::DrawnCamera camera;
  paint(camera, tests::spread_poses(board_, camera, 3));
  const tests::Outcome outcome = tests::run(
      "hovermodal", "calibrate " + (folder_ / "frames").string() + " --board 10x7 --square-mm 25 --out " + out());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("give --board 9x6"), HasSubstr("0 of 3 images")));
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(Calibrate, RefusesTheSameViewOverAndOver) {
  const tests::DrawnCamera camera;
  const tests::DrawnPose pose = tests::board_pose(board_, {0.0, 0.0, 400.0}, 10.0, 0.0, 0.0);
  paint(camera, {pose, pose, pose, pose});
  EXPECT_THAT(calibrate("").text, HasSubstr("same place in all 4 images"));
}

TEST_F(Calibrate, RefusesWhatItCannotUse) {
  std::filesystem::create_directories(folder_ / "frames");
  cv::imwrite((folder_ / "frames" / "a.png").string(), cv::Mat(480, 640, CV_8U, cv::Scalar(128)));
  EXPECT_THAT(calibrate("").text, HasSubstr("found in 0 of 1 images"));
  EXPECT_EQ(calibrate("", "missing").exit_code, 2);
  cv::imwrite((folder_ / "b.png").string(), cv::Mat(200, 300, CV_8U, cv::Scalar(128)));
  const tests::Outcome sizes = calibrate((folder_ / "b.png").string());
  EXPECT_EQ(sizes.exit_code, 2);
  EXPECT_THAT(sizes.text, AllOf(HasSubstr("300 x 200 px"), HasSubstr("640 x 480 px")));
  for (const char* board : {"9", "9x", "x6", "2x6", "9x6x3", "999x6", "-9x6"}) {
    const tests::Outcome outcome = tests::run("hovermodal", "calibrate " + (folder_ / "frames").string() + " --board " +
                                                                std::string(board) + " --square-mm 25 --out " + out());
    EXPECT_EQ(outcome.exit_code, 2) << board;
  }
  EXPECT_EQ(calibrate("--square-mm 0").exit_code, 2);
  EXPECT_EQ(calibrate("--model omni").exit_code, 2);
}

TEST_F(Calibrate, HelpTeachesHowToFilmTheBoard) {
  const tests::Outcome outcome = tests::run("hovermodal", "calibrate --help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("HOW TO FILM"), HasSubstr("Tilt it"), HasSubstr("inner corners")));
}

}  // namespace
