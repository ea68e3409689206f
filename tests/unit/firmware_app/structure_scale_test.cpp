#include "firmware_app/config/structure_scale.h"

#include <fmt/format.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "firmware_app/config/calibration.h"
#include "firmware_app/config/config_image.h"
#include "tests/support/config_text.h"
#include "tests/support/folder_test.h"

namespace app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

core::CameraInfo info(int width_px, int height_px) {
  core::CameraInfo out;
  out.width_px = width_px, out.height_px = height_px, out.rate_hz = 25.0;
  return out;
}

AppConfig config(const std::string& more) {
  return parse_config(
      "camera: {source: a.mp4}\nregions:\n  - {name: low, rect: [400, 900, 201, 51]}\n"
      "  - {name: high, rect: [400, 100, 201, 51]}\n" +
          more,
      "a.yaml");
}
StructureScale scale_of(const std::string& more) {
  const AppConfig c = config(more);
  return structure_scale(c, camera_model(c, info(1920, 1080)));
}
std::string refusal(const std::string& more) {
  try {
    (void)scale_of(more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return {};
}

constexpr const char* kCalibration = "calibration: {fx: 2000, fy: 2000, cx: 960, cy: 540}\n";

TEST(StructureScale, WithoutALengthThereAreOnlyPixels) {
  const StructureScale scale = scale_of("");
  EXPECT_FALSE(scale.known);
  EXPECT_EQ(scale.mm_per_px, 1.0);
  EXPECT_THAT(scale.notes, IsEmpty());
}

TEST(StructureScale, OneLengthLeavesObliquenessOpenAndSaysHowMuch) {
  const StructureScale scale =
      scale_of(std::string(kCalibration) + "scale: {known_length_mm: 200, from: [400, 500], to: [800, 500]}\n");
  EXPECT_DOUBLE_EQ(scale.mm_per_px, 0.5);
  ASSERT_EQ(scale.notes.size(), 1U);
  // Inclined by 10 degrees over 800 px of 2000: (1 + 0.2 tan 10) / (1 - 0.2 tan 10) = 1.073 between them.
  EXPECT_THAT(scale.notes[0], AllOf(HasSubstr("up to 10 degrees"), HasSubstr("up to 7."), HasSubstr("between regions"),
                                    HasSubstr("scale.points would determine it")));
  EXPECT_THAT(scale_of("scale: {known_length_mm: 200, from: [400, 500], to: [800, 500]}\n").notes[0],
              HasSubstr("without a calibration"));
}

TEST(StructureScale, SeveralLengthsGiveOneScaleAndNameTheOneThatDisagrees) {
  const StructureScale scale = scale_of("scale: {lengths: [[0, 0, 400, 0, 200], [0, 9, 800, 9, 400]]}\n");
  EXPECT_NEAR(scale.mm_per_px, 0.5, 1e-12);
  EXPECT_GT(scale.sigma, 0.0);
  EXPECT_THAT(scale.notes[0], HasSubstr("from 2 lengths"));
  EXPECT_THAT(scale_of("scale: {lengths: [[0, 0, 400, 0, 200], [0, 9, 800, 9, 400], [0, 5, 400, 5, 230]]}\n").notes[1],
              AllOf(HasSubstr("disagree"), HasSubstr("number 3")));
}

TEST(StructureScale, ARegionsOwnLengthIsItsScale) {
  AppConfig c = config("scale: {known_length_mm: 200, from: [400, 500], to: [800, 500]}\n");
  c.regions[1].length_mm = 120.0, c.regions[1].length_from_px = {400.0, 100.0},
  c.regions[1].length_to_px = {600.0, 100.0};
  const StructureScale scale = structure_scale(c, {});
  EXPECT_DOUBLE_EQ(scale.region_mm_per_px[0], 0.5);
  EXPECT_DOUBLE_EQ(scale.region_mm_per_px[1], 0.6);
}

// A plane at 4 m, inclined backward by 30 degrees about u: z = 4000 + y / 2.
std::string points(double wrong_mm = 0.0) {
  std::string text = "scale: {points: [";
  for (const auto& [x, y] :
       {std::pair{-500.0, -600.0}, {500.0, -600.0}, {500.0, 600.0}, {-500.0, 600.0}, {0.0, 300.0}}) {
    const double z = 4000.0 + 0.5 * y;
    text += fmt::format("[{}, {}, {}, {}], ", 960.0 + 2000.0 * x / z, 540.0 + 2000.0 * std::sqrt(0.75) * y / z,
                        x + (x == 0.0 ? wrong_mm : 0.0), y);
  }
  return text + "]}\n";
}

TEST(StructureScale, PointsOfThePlaneGiveEveryRegionItsScale) {
  const StructureScale scale = scale_of(kCalibration + points());
  ASSERT_TRUE(scale.plane);
  EXPECT_NEAR(scale.plane->obliqueness_deg(), 30.0, 0.01);
  EXPECT_THAT(scale.notes[0], AllOf(HasSubstr("from 5 points"), HasSubstr("30.0 +-")));
  // Along u the scale is depth over focal length, at the row of the region's centre: v = 925 and 125.
  for (const auto& [i, v] : {std::pair{0U, 925.0}, {1U, 125.0}}) {
    const double y_ray = (v - 540.0) / 2000.0;
    const double z = 4000.0 / (1.0 - y_ray * 0.5 / std::sqrt(0.75));
    EXPECT_NEAR(scale.region_mm_per_px[i], z / 2000.0, 1e-4) << i;
  }
}

TEST(StructureScale, RefusesPointsThatShowNoPlane) {
  EXPECT_THAT(refusal(points()), HasSubstr("scale.points: 5 points is refused: allowed with a calibration"));
  EXPECT_THAT(refusal(kCalibration + points(400.0)), AllOf(HasSubstr("contradict"), HasSubstr("number 5 most")));
  EXPECT_THAT(refusal(std::string(kCalibration) +
                      "scale: {points: [[0, 0, 0, 0], [10, 10, 1, 1], [20, 20, 2, 2], [30, 30, 3, 3]]}\n"),
              HasSubstr("on one line"));
  EXPECT_THAT(refusal("scale: {points: [[0, 0, 0, 0], [10, 10, 1, 1]]}\n"), HasSubstr("4 to 1000 rows"));
  EXPECT_THAT(refusal("scale: {points: [[0, 0, 0], [1, 1, 1], [2, 2, 2], [3, 3, 3]]}\n"),
              HasSubstr("row 1: write a list of 4 numbers"));
  EXPECT_THAT(refusal("scale: {lengths: [[0, 0, 10, .nan, 5]]}\n"), HasSubstr("row 1, number 4"));
  EXPECT_THAT(refusal("scale: {lengths: [[0, 0, 1, 0, 5]]}\n"), HasSubstr("give the length two different ends"));
  EXPECT_THAT(refusal("scale: {lengths: [[0, 0, 9, 0, 5]], known_length_mm: 1, from: [0, 0], to: [5, 5]}\n"),
              HasSubstr("one of known_length_mm, lengths and points"));
  EXPECT_THROW(check_against_image(config("scale: {lengths: [[0, 0, 900, 0, 5]]}\n"), 800, 1080), ConfigError);
}

class CalibrationOfConfig : public tests::FolderTest {
 protected:
  [[nodiscard]] std::string refused(int width_px, int height_px, const std::string& file_text) const {
    try {
      (void)camera_model(config("calibration: {file: " + file(file_text) + "}\n"), info(width_px, height_px));
    } catch (const std::exception& error) {
      return error.what();
    }
    return {};
  }
};

constexpr const char* kKalibr =
    "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.1, 0.02, 0.0, 0.0]\n  distortion_model: radtan\n"
    "  intrinsics: [2000.0, 2010.0, 959.5, 539.5]\n  resolution: [1920, 1080]\n";

TEST_F(CalibrationOfConfig, IsReadFromAFile) {
  const AppConfig c = config("calibration: {file: " + file(kKalibr) + "}\n");
  const core::CameraModel camera = camera_model(c, info(1920, 1080));
  EXPECT_EQ(camera.fy, 2010.0);
  EXPECT_EQ(camera.distortion[1], 0.02);
}

TEST_F(CalibrationOfConfig, OfAnotherResolutionIsRefusedWithWhatScalingWouldGive) {
  EXPECT_THAT(refused(3840, 2160, kKalibr),
              AllOf(HasSubstr("is for 1920 x 1080 px, the camera gives 3840 x 2160 px"), HasSubstr("fx 4000.00"),
                    HasSubstr("cx 1919.50"), HasSubstr("many cameras crop")));
  EXPECT_THAT(refused(1440, 1080, kKalibr), AllOf(HasSubstr("1440 x 1080"), HasSubstr("crop"), Not(HasSubstr("fx "))));
}

TEST_F(CalibrationOfConfig, OfTheValuesInPlaceMustFitTheImageToo) {
  const auto inline_refusal = [](const std::string& values) {
    try {
      (void)camera_model(config("calibration: {" + values + "}\n"), info(1920, 1080));
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(inline_refusal("fx: 2000, fy: 2000, cx: 959.5, cy: 539.5"), "");
  EXPECT_THAT(inline_refusal("fx: 2000, fy: 2000, cx: 2500, cy: 539.5"),
              HasSubstr("calibration: principal point (2500"));
  EXPECT_THAT(inline_refusal("fx: 2000, fy: 2000, cx: 959.5, cy: 539.5, distortion: [-2, 0, 0, 0]"),
              HasSubstr("folds"));
  EXPECT_THAT(inline_refusal("model: equidistant, fx: 300, fy: 300, cx: 959.5, cy: 539.5, distortion: [0, 0, 0, 0]"),
              AllOf(HasSubstr("regions.0.rect"), HasSubstr("90 degrees")));
  EXPECT_THAT(inline_refusal("model: equidistant, fx: 900, fy: 900, cx: 959.5, cy: 539.5, distortion: [0, 0, 0, 0, 1]"),
              HasSubstr("[k1, k2, k3, k4] with model equidistant"));
}

}  // namespace
}  // namespace app
