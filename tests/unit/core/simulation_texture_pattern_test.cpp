#include "core/simulation/render/texture_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "core/simulation/presets.h"
#include "core/simulation/render/render_textures.h"
#include "core/simulation/render/texture.h"
#include "core/simulation/scene.h"

namespace core::simulation {
namespace {

using Shows = TextureParameters::Shows;

TEST(TexturePattern, AStoreyHasAWallWindowsAndASlab) {
  const TexturePattern facade = facade_pattern(300.0, 140.0, 1, 2);  // four fields of 75 mm
  EXPECT_DOUBLE_EQ(facade(0.0, 0.0).grey, 0.0);                      // the wall between the second field and the third
  EXPECT_GT(facade(0.0, 65.0).grey, 20.0);                           // the slab's edge
  std::set<double> glass;
  for (const double middle_mm : {-112.5, -37.5, 37.5, 112.5}) {
    EXPECT_GT(facade(middle_mm, -20.0).grey, 40.0) << middle_mm;  // the bar in the middle of a window
    EXPECT_LT(facade(middle_mm + 10.0, 20.0).grey, -40.0) << middle_mm;
    glass.insert(facade(middle_mm + 10.0, 0.0).grey);
  }
  EXPECT_EQ(glass.size(), 4U) << "every window is another";
}

TEST(TexturePattern, ALandscapeHasSkyTownAndGround) {
  const TexturePattern landscape = landscape_pattern(1000.0, 1);
  double town = 0.0;
  int n = 0;
  for (double x_mm = -1700.0; x_mm < 1700.0; x_mm += 23.0, ++n) {
    EXPECT_GT(landscape(x_mm, -800.0).grey, 40.0);
    EXPECT_LT(landscape(x_mm, 400.0).grey, -20.0);
    town += landscape(x_mm, 280.0).grey;
  }
  EXPECT_LT(town / n, -20.0);
}

// The coefficients' average over a window that is wide against the grid.
TEST(TexturePattern, ATextureShowsItOnTheSideOfTheOriginWhereItIs) {
  TextureParameters flat{2.0, 100.0, 1e-3};
  const auto step = [](double x_mm, double y_mm) -> PatternPoint {
    return {(x_mm < 0.0 ? -20.0 : 30.0) + (y_mm < 0.0 ? 0.0 : 5.0), 1.0};
  };
  const Texture texture(flat, 64, 1, "test", 0, step);
  EXPECT_NEAR(texture.value(-20.0, -20.0), 80.0, 0.1);
  EXPECT_NEAR(texture.value(20.0, -20.0), 130.0, 0.1);
  EXPECT_NEAR(texture.value(20.0, 20.0), 135.0, 0.1);
  EXPECT_NEAR(texture.value(-20.0, 20.0), 85.0, 0.1);
}

TEST(TexturePattern, NoiseIsTheSameWithAndWithoutAPattern) {
  const TextureParameters noise{2.0, 100.0, 10.0};
  const Texture without(noise, 64, 1, "test");
  const Texture with(noise, 64, 1, "test", 0, [](double, double) -> PatternPoint { return {7.0, 1.0}; });
  for (double x_mm = -30.0; x_mm < 30.0; x_mm += 1.7)
    EXPECT_NEAR(with.value(x_mm, 0.3 * x_mm), without.value(x_mm, 0.3 * x_mm) + 7.0, 1e-3);
}

TEST(TexturePattern, AFacadeIsAPlatesAndALandscapeTheBackgrounds) {
  Scene scene = make_paper_scene(1, 10.0);
  scene.plates[2].texture.shows = Shows::kFacade;
  scene.background.texture.shows = Shows::kLandscape;
  EXPECT_NO_THROW(validate(scene));
  scene.plates[2].texture.shows = Shows::kLandscape;
  EXPECT_THROW(validate(scene), std::invalid_argument);
  scene.plates[2].texture.shows = Shows::kNoise;
  scene.background.texture.shows = Shows::kFacade;
  EXPECT_THROW(validate(scene), std::invalid_argument);
}

}  // namespace
}  // namespace core::simulation
