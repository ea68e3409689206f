#include "core/simulation/presets.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/simulation/scene_motion.h"

namespace core::simulation {
namespace {

class Preset : public testing::TestWithParam<PresetInfo> {
 protected:
  Scene scene_ = GetParam().make(3, 20.0);
};

TEST_P(Preset, IsAValidSceneAtEverySize) {
  for (const auto& [width, height] : {std::pair{1920, 1080}, {3840, 2160}, {1280, 720}, {640, 480}, {320, 180}}) {
    Scene scene = scene_;
    set_image_size(scene, width, height);
    EXPECT_NO_THROW(validate(scene)) << width << " x " << height;
    EXPECT_EQ(scene.seed, 3U);
    EXPECT_EQ(scene.duration_s, 20.0);
  }
}

// A tracking window needs some 20 px; a texture finer than 2.5 px would alias.
TEST_P(Preset, ShowsPlatesAndTexturesThatCanBeTracked) {
  for (const Plate& plate : scene_.plates) {
    const double px_per_mm = scene_.camera.alpha_px / plate.z_mm;
    EXPECT_GE(plate.height_mm * px_per_mm, 25.0) << plate.name;
    EXPECT_GE(plate.width_mm * px_per_mm, 25.0) << plate.name;
    EXPECT_GE(plate.texture.pitch_mm * px_per_mm, 2.5) << plate.name;
  }
}

TEST_P(Preset, IsMarkedByOneRegionForEachBodyAndTheBackground) {
  const SceneMotion motion(scene_);
  const std::vector<SceneRegion> regions = tracking_regions(motion);
  ASSERT_EQ(regions.size(), scene_.plates.size() + 1);
  const double upright = scene_.structure.axis == StructureModel::Axis::kY ? 90.0 : 0.0;
  std::set<std::string> names;
  for (const SceneRegion& region : regions) {
    names.insert(region.region.name);
    EXPECT_NEAR(region.region.axis_deg, upright, 1.0) << region.region.name;
  }
  EXPECT_EQ(names.size(), regions.size());
  EXPECT_EQ(names.count("base"), 1U);
}

TEST_P(Preset, MovesAsDeclared) {
  const StructureResponse response(scene_);
  EXPECT_EQ(response.rms_mm(0) > 0.0, scene_.excitation.base > 0.0);
  EXPECT_GT(response.roof_relative_rms_mm(), 0.9 * scene_.excitation.rms_mm);
  EXPECT_LT(response.roof_relative_rms_mm(), 1.5 * scene_.excitation.rms_mm);
}

// All contents of an image scale with it: a point of each plate keeps its position relative to the image's middle.
TEST_P(Preset, ScalesWithTheImage) {
  Scene half = scene_, back = scene_;
  set_image_size(half, 960, 540);
  EXPECT_DOUBLE_EQ(half.camera.alpha_px, 0.5 * scene_.camera.alpha_px);
  EXPECT_DOUBLE_EQ(half.plates[1].texture.pitch_mm, 2.0 * scene_.plates[1].texture.pitch_mm);
  EXPECT_DOUBLE_EQ(half.background.texture.pitch_mm, 2.0 * scene_.background.texture.pitch_mm);
  EXPECT_DOUBLE_EQ(half.camera.cx_px, 479.5);
  EXPECT_DOUBLE_EQ(half.camera.cy_px, 269.5);
  back.camera.cx_px += 40.0;
  set_image_size(back, 960, 540);
  EXPECT_DOUBLE_EQ(back.camera.cx_px, 479.5 + 20.0);
}

INSTANTIATE_TEST_SUITE_P(All, Preset, testing::ValuesIn(presets()), [](const auto& each) { return each.param.name; });

double frequency(const Scene& scene, std::size_t mode) { return modes_of(scene.structure)[mode].frequency_hz; }

TEST(Presets, HaveTheModesThatTheirDescriptionsSay) {
  EXPECT_NEAR(frequency(make_paper_scene(1, 10.0), 5), 14.34, 1e-9);
  EXPECT_NEAR(frequency(make_cantilever_scene(1, 10.0), 0), 0.77, 0.01);
  EXPECT_NEAR(frequency(make_cantilever_scene(1, 10.0), 2), 13.6, 0.1);
  EXPECT_NEAR(frequency(make_shear_frame_scene(1, 10.0), 0), 2.3, 0.05);
  EXPECT_NEAR(frequency(make_shear_frame_scene(1, 10.0), 3), 10.9, 0.05);
  for (const int r : {1, 2, 3}) {
    EXPECT_NEAR(frequency(make_deck_scene(1, 10.0), static_cast<std::size_t>(r) - 1), 1.9 * r * r, 0.01);
  }
}

TEST(Presets, AreFoundByName) {
  EXPECT_EQ(make_preset("deck", 5, 12.0).plates.size(), 8U);
  EXPECT_EQ(make_preset("paper", 5, 12.0).seed, 5U);
  try {
    (void)make_preset("tower", 1, 10.0);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("paper, cantilever, shear_frame, deck"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace core::simulation
