#include "firmware_app/report/structure_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "firmware_app/report/structure_pictures.h"

namespace app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

core::closure::LoopResult compared() {
  core::closure::LoopResult out;
  core::closure::LoopLevel level;
  level.level = "structure", level.unit = "%";
  level.result.emplace();
  core::closure::ClosureMode mode;
  mode.number = 1, mode.frequency_hz = 2.0, mode.reference_hz = 2.1, mode.error_percent = -4.8;
  level.result->modes_before = {mode};
  mode.error_percent = 0.1;
  level.result->modes_after = {mode};
  level.pictures = {{"Measured and computed <shapes>", "<svg id=\"mine\"></svg>"}};
  out.levels.push_back(std::move(level));
  return out;
}

const std::string kPage =
    "<nav>\n<a href=\"#closure\">Residual</a>\n<a href=\"#losses\">Losses</a>\n</nav>\n"
    "<section id=\"closure\">\n</section>\n<section id=\"losses\">\n</section>\n";

TEST(StructureSection, HoldsTheErrorsAndEveryPicture) {
  const std::string html = structure_section(compared());
  EXPECT_THAT(html, HasSubstr("<section id=\"structure\">"));
  EXPECT_THAT(html, HasSubstr("&lt;shapes&gt;"));
  EXPECT_THAT(html, HasSubstr("id=\"mine\""));
  core::closure::LoopResult skipped = compared();
  skipped.levels.front().result.reset();
  EXPECT_EQ(structure_section(skipped), "");
}

TEST(StructureSection, StandsInTheReportBeforeTheLossesAndOnce) {
  const std::string section = structure_section(compared());
  const std::string page = with_structure_section(kPage, section);
  EXPECT_LT(page.find("#structure\">Structure"), page.find("#losses"));
  EXPECT_GT(page.find("<section id=\"structure\">"), page.find("<section id=\"closure\">"));
  EXPECT_LT(page.find("<section id=\"structure\">"), page.find("<section id=\"losses\">"));
  EXPECT_EQ(with_structure_section(page, section), page) << "a second run replaces the first one's";
  EXPECT_EQ(with_structure_section(kPage, ""), kPage);
  EXPECT_EQ(with_structure_section("another page", section), "another page");
}

TEST(StructureDrawing, MarksWhatWasFoundAndWhatIsAlike) {
  DrawnPart low{0, 0, 0, 5, true, {}, false}, high{0, 5, 0, 10, true, "soft_part", true},
      node{0, 5, 0, 5, false, {}, true};
  const std::string svg = structure_drawing_svg({low, high, node}, {{0, 9}});
  EXPECT_THAT(svg, HasSubstr("soft_part"));
  EXPECT_THAT(svg, HasSubstr("stroke-width=\"5\""));
  EXPECT_THAT(svg, HasSubstr("k1 n"));
  high.found.clear();
  EXPECT_THAT(structure_drawing_svg({low, high}, {}), Not(HasSubstr("stroke-width=\"5\"")));
  EXPECT_EQ(structure_drawing_svg({}, {}), "");
}

}  // namespace
}  // namespace app
