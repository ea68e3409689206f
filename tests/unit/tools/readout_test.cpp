#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "tests/support/answers.h"
#include "tests/support/folder_test.h"

// `hovermodal readout` as a user runs it.
namespace {

using testing::HasSubstr;

constexpr double kFocal_px = 300.0, kRate_hz = 25.0;
constexpr int kWidth_px = 320, kHeight_px = 240, kFrames = 60;

// Rotation vector of a camera that is shaken about all axes, rad.
Eigen::Vector3d shaken(double t) {
  return {0.03 * std::sin(6.1 * t), 0.03 * std::sin(8.3 * t + 1.0), 0.03 * std::sin(7.2 * t + 2.0)};
}
Eigen::Matrix3d attitude(double t) {
  const Eigen::Vector3d v = shaken(t);
  return Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix();
}

// Frames of a far texture by a global shutter, and the camera's own rates.
class Readout : public tests::FolderTest {
 protected:
  void SetUp() override {
    tests::FolderTest::SetUp();
    std::filesystem::create_directories(folder_ / "frames");
    cv::Mat texture(kHeight_px, kWidth_px, CV_8UC1);
    cv::RNG random(5);
    random.fill(texture, cv::RNG::UNIFORM, 0, 255);
    cv::GaussianBlur(texture, texture, {0, 0}, 2.0);
    cv::normalize(texture, texture, 0, 255, cv::NORM_MINMAX);
    Eigen::Matrix3d camera;
    camera << kFocal_px, 0, 0.5 * (kWidth_px - 1), 0, kFocal_px, 0.5 * (kHeight_px - 1), 0, 0, 1;
    std::ofstream stamps(folder_ / "stamps.txt"), gyro(folder_ / "gyro.txt");
    for (int k = 0; k < kFrames; ++k) {
      const double t = 1.0 + k / kRate_hz;
      const Eigen::Matrix3d h = camera * attitude(t).transpose() * camera.inverse();
      cv::Mat homography, frame;
      cv::eigen2cv(h, homography);
      cv::warpPerspective(texture, frame, homography, texture.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT);
      cv::imwrite((folder_ / "frames" / cv::format("f%03d.png", k)).string(), frame);
      stamps << t << '\n';
    }
    for (int k = 0; k < 200 * 5; ++k) {
      const double t = k / 200.0, step = 1e-4;
      const Eigen::AngleAxisd turn(attitude(t - step).transpose() * attitude(t + step));
      const Eigen::Vector3d rate = turn.angle() / (2.0 * step) * turn.axis();
      gyro << rate.x() << ',' << rate.y() << ',' << rate.z() << ',' << t << '\n';
    }
  }
  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string command() const {
    return "readout --clip " + path("frames") + " --stamps " + path("stamps.txt") + " --gyro " + path("gyro.txt");
  }
};

TEST_F(Readout, PrintsTheReadoutOfAGlobalShutterAsJson) {
  const nlohmann::json told = tests::expect_answers(command() + " --force --picture " + path("residual.svg"));
  EXPECT_NEAR(told["readout_ms"]["value"].get<double>(), 0.0, 2.0);
  EXPECT_GT(told["readout_ms"]["sigma"].get<double>(), 0.0);
  EXPECT_NEAR(told["focal_px"]["value"].get<double>(), kFocal_px, 0.05 * kFocal_px);
  EXPECT_EQ(told["half_readout_ms"].size(), 2U);
  EXPECT_EQ(told["frame_pairs"], kFrames - 1);
  EXPECT_THAT(tests::run_apart(command()).out, HasSubstr("readout_ms\t"));
}

// The clip lacks the first frames of its stamps: the gyro then covers the frames, but not enough on either side.
TEST_F(Readout, AClipThatBeginsLaterThanItsStampsIsToldTheOption) {
  std::ofstream stamps(folder_ / "early.txt");
  for (int k = -20; k < kFrames; ++k) stamps << 1.0 + k / kRate_hz << '\n';
  stamps.close();
  std::ofstream gyro(folder_ / "short.txt");
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.1 + k / 200.0;
    gyro << "0.1,0.2,0.3," << t << '\n';
  }
  gyro.close();
  const tests::Streams outcome = tests::run_apart("readout --clip " + path("frames") + " --stamps " +
                                                  path("early.txt") + " --gyro " + path("short.txt"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--first-stamp is the line of its first frame (the clip has 60 frames, "));
  EXPECT_THAT(outcome.err, HasSubstr("early.txt has 80 stamps from there on)"));
  EXPECT_THAT(outcome.err, HasSubstr("--time-unit-s"));
}

TEST_F(Readout, ReplacesAPictureOnlyWithForce) {
  std::ofstream(path("residual.svg")) << "mine";
  const tests::Streams outcome = tests::run_apart(command() + " --picture " + path("residual.svg"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("residual.svg: exists; name another file, or --force"));
  EXPECT_EQ(tests::read(path("residual.svg")), "mine");
}

}  // namespace
