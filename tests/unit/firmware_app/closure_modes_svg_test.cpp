#include "firmware_app/report/closure_modes_svg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace app {
namespace {

core::closure::ClosureMode mode(int number, double error_percent) {
  core::closure::ClosureMode out;
  out.number = number;
  out.frequency_hz = number;
  out.error_percent = error_percent;
  return out;
}

// Centres of the dots, which mark the errors after; the last one belongs to the legend.
std::vector<double> dots_px(const std::string& svg) {
  std::vector<double> out;
  const std::string key = "<circle cx=\"";
  for (std::size_t at = svg.find(key); at != std::string::npos; at = svg.find(key, at + 1))
    out.push_back(std::stod(svg.substr(at + key.size())));
  return out;
}

TEST(ClosureModesSvg, ModesThatOnlyTheRepairedRecordHoldsLieWithinThePanel) {
  core::closure::ClosureResult result;
  result.modes_before = {mode(1, 0.5), mode(2, -0.4)};
  result.modes_after = {mode(1, 0.1), mode(2, -0.1), mode(3, 0.2), mode(4, 0.3)};
  const auto dots = dots_px(closure_modes_svg(result));
  ASSERT_EQ(dots.size(), 5U);
  EXPECT_TRUE(std::is_sorted(dots.begin(), dots.end())) << "the legend stands to the right of all modes";

  core::closure::ClosureResult both = result;
  both.modes_before = result.modes_after;
  const auto same = dots_px(closure_modes_svg(both));
  EXPECT_EQ(dots, same) << "the axis holds the same modes";
}

TEST(ClosureModesSvg, WithoutAReferenceThereIsNoPicture) {
  core::closure::ClosureResult result;
  core::closure::ClosureMode unknown;
  unknown.number = 1;
  result.modes_before = {unknown};
  EXPECT_EQ(closure_modes_svg(result), "");
}

}  // namespace
}  // namespace app
