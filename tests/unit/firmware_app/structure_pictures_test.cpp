#include "firmware_app/report/structure_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(StructurePictures, EveryMeasuredShapeHasItsPanelWithBothModels) {
  ShapeComparison mode;
  mode.number = 2, mode.measured_hz = 3.25, mode.mac_before = 0.91, mode.mac_after = 0.999;
  mode.measured = {0.4, 1.0}, mode.sigma = {0.01, 0.01}, mode.before = {0.6, 0.9}, mode.after = {0.41, 1.0};
  const std::string svg = structure_shapes_svg({mode, mode, mode, mode, mode}, {"roof<", "deck"});
  EXPECT_EQ(count(svg, "3.25 Hz measured"), 5U);
  EXPECT_EQ(count(svg, "stroke-dasharray=\"4 3\""), 5U);
  EXPECT_THAT(svg, HasSubstr("MAC 0.9100 to 0.9990"));
  EXPECT_THAT(svg, HasSubstr("roof&lt;"));
  EXPECT_EQ(structure_shapes_svg({}, {}), "");
}

TEST(StructurePictures, ThePlaceFoundIsFilledAndItsLikesAreRinged) {
  const std::string svg =
      structure_places_svg("soft_part", {{"storey 1", 0.0, true, true},
                                         {"storey 2", 2.5, false, true},
                                         {"storey 3", std::numeric_limits<double>::infinity(), false, false}});
  EXPECT_EQ(count(svg, "class=\"m1\""), 1U);
  EXPECT_EQ(count(svg, "class=\"k1 n\""), 2U);
  EXPECT_THAT(svg, HasSubstr("no fit"));
  EXPECT_EQ(structure_places_svg("soft_part", {}), "");
}

TEST(StructurePictures, ManyPlacesAreCountedNotDrawn) {
  const std::string svg = structure_places_svg("added_mass", std::vector<SoughtPlace>(75, {"node", 1.0, false, false}));
  EXPECT_THAT(svg, HasSubstr("15 more places are not drawn"));
}

TEST(StructurePictures, AParameterWithoutSigmaSaysSo) {
  const std::string svg = structure_posterior_svg(
      {{"tension", "N", 3.1e6, 2.0e4, 3.0e6, 9.0e5}, {"soft_part: stiffness_ratio", "1", 0.05, {}, {}, {}}});
  EXPECT_THAT(svg, HasSubstr("3.1e+06 ± 2e+04 N"));
  EXPECT_THAT(svg, HasSubstr("(no sigma)"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(structure_posterior_svg({}), "");
}

}  // namespace
}  // namespace app
