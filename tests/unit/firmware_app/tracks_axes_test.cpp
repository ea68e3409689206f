#include "firmware_app/replay/tracks_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace app {
namespace {

constexpr const char* kText = R"(camera: {driver: synthetic}
regions:
  - {name: low, rect: [0, 0, 40, 40]}
  - {name: high, rect: [0, 50, 40, 40]}
  - {name: ground, rect: [0, 100, 40, 40], role: ground}
)";

// Ten points a region; `high` moves up and down.
drivers::TracksFile tracks() {
  drivers::TracksFile file;
  file.region_names = {"ground", "high", "low"};
  for (int k = 0; k < 250; ++k) {
    core::TrackFrame frame;
    frame.sequence = static_cast<std::uint64_t>(k);
    frame.t_start_ns = 40'000'000LL * k;
    for (std::uint32_t i = 0; i < 30; ++i) {
      const auto region = static_cast<std::uint16_t>(i / 10);
      const double v = region == 1 ? 0.5 * std::sin(2.0 * std::numbers::pi * 3.0 * 0.04 * k) : 0.0;
      frame.points.push_back({4.0 * (i % 10), 20.0 + v, 0.01, i, region, true, true});
    }
    file.frames.push_back(frame);
  }
  return file;
}

TEST(TracksAxes, AreThoseThatTheFileStates) {
  drivers::TracksFile file = tracks();
  file.region_axes = {"auto", "auto both", "30"};
  const AppConfig config = with_axes_of(file, parse_config(kText, "a.yaml"));
  EXPECT_EQ(config.regions[0].axis_deg, 30.0);
  EXPECT_TRUE(config.regions[1].both_axes);
  EXPECT_EQ(config.regions[1].axis_from, core::AxisFrom::kMotion);
}

TEST(TracksAxes, AreFoundWhereTheFileSaysNothing) {
  const AppConfig config = with_axes_of(tracks(), parse_config(kText, "a.yaml"));
  EXPECT_EQ(config.regions[1].axis_from, core::AxisFrom::kMotion);
  EXPECT_EQ(config.regions[1].axis_deg, 90.0);
  EXPECT_EQ(config.regions[0].axis_deg, 90.0);
}

TEST(TracksAxes, LeaveADeclaredAxisAlone) {
  const AppConfig config = with_axes_of(tracks(), parse_config(kText, "a.yaml", {"regions.1.axis=u"}));
  EXPECT_EQ(config.regions[1].axis_from, core::AxisFrom::kDeclared);
  EXPECT_EQ(config.regions[1].axis_deg, 0.0);
}

}  // namespace
}  // namespace app
