#include "firmware_app/report/plot/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SvgPlot, TicksAreRoundAndInside) {
  std::vector<std::string> labels;
  for (const PlotTick& tick : ticks_of({-0.31, 0.42, false, {}}, 4)) labels.push_back(tick.label);
  EXPECT_THAT(labels, ElementsAre("−0.2", "0.0", "0.2", "0.4"));
  std::vector<int> exponents;
  for (const PlotTick& tick : ticks_of(log_axis_around(0.002, 50.0, 8, {}), 10)) exponents.push_back(tick.exponent);
  EXPECT_THAT(exponents, ElementsAre(-3, -2, -1, 0, 1, 2));
}

TEST(SvgPlot, DecimationKeepsExtremesAndGaps) {
  std::vector<PlotPoint> points;
  for (int i = 0; i < 10'000; ++i) points.push_back({0.1 * i, i >= 2000 && i < 4000 ? kNan : std::sin(0.001 * i)});
  points[7777].y = 50.0, points[8888].y = -60.0;
  const std::vector<PlotPoint> few = decimated(points, 200);
  EXPECT_LE(few.size(), 200U);
  const auto has = [&](double y) {
    return std::any_of(few.begin(), few.end(), [&](const PlotPoint& p) { return p.y == y; });
  };
  EXPECT_TRUE(has(50.0));
  EXPECT_TRUE(has(-60.0));
  EXPECT_TRUE(std::any_of(few.begin(), few.end(), [](const PlotPoint& p) { return std::isnan(p.y); }));
  for (std::size_t i = 1; i < few.size(); ++i) EXPECT_GT(few[i].x, few[i - 1].x);
}

TEST(SvgPlot, LabelsInOneRowDoNotTouch) {
  const std::vector<double> x{100.0, 110.0, 120.0, 400.0};
  const std::vector<std::string> labels(4, "10.00 Hz");
  EXPECT_THAT(label_rows(x, labels, 2), ElementsAre(0, 1, -1, 0));
}

TEST(SvgDocument, NumbersAreShortAndGapsSplitAPath) {
  EXPECT_EQ(svg_number(1.25), "1.3");
  EXPECT_EQ(svg_number(-0.52), "-.5");
  EXPECT_EQ(svg_number(-0.01), "0");
  EXPECT_EQ(svg_number(kNan), "0");
  SvgDocument svg(10.0, 10.0, "t");
  const std::vector<PlotPoint> points{{1, 2}, {2, 1.5}, {kNan, 0}, {5, 5}, {6, kNan}};
  svg.path(points, "k0");
  EXPECT_THAT(svg.text_of(), HasSubstr("d=\"M1 2l1-.5M5 5h0\""));
}

TEST(SvgDocument, CutsTextBetweenCharacters) {
  EXPECT_EQ(shortened("étage", 5), "étage");
  EXPECT_EQ(shortened("éééé", 3), "éé…");
  EXPECT_EQ(shortened_inside("deck panel 12", 9), "deck…l 12");
  EXPECT_EQ(shortened_inside("étage", 5), "étage");
}

}  // namespace
}  // namespace app
