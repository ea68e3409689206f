#include "firmware_app/replay/tracks_axes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/folder_test.h"

namespace app {
namespace {

constexpr const char* kText = R"(camera: {driver: synthetic}
regions:
  - {name: low, rect: [0, 0, 40, 40]}
  - {name: high, rect: [0, 50, 40, 40]}
  - {name: ground, rect: [0, 100, 40, 40], role: ground}
)";

// Ten points a region; `high` moves up and down.
class TracksAxes : public tests::FolderTest {
 protected:
  [[nodiscard]] drivers::TracksFile tracks() const {
    std::string text = "# image_size_px: 640 x 480\n# rate_hz: 25\n# regions: ground,high,low\n";
    text += "frame,t_s,point,region,u_px,v_px,sigma_px\n";
    constexpr std::array<const char*, 3> kRegions{"ground", "high", "low"};
    for (int k = 0; k < 250; ++k) {
      for (std::size_t i = 0; i < 30; ++i) {
        const std::size_t region = i / 10;
        const double v = region == 1 ? 0.5 * std::sin(2.0 * std::numbers::pi * 3.0 * 0.04 * k) : 0.0;
        text +=
            fmt::format("{},{:.2f},{},{},{},{:.6f},0.01\n", k, 0.04 * k, i, kRegions[region], 4 * (i % 10), 20.0 + v);
      }
    }
    return drivers::read_tracks_csv(file(text));
  }
};

TEST_F(TracksAxes, AreThoseThatTheFileStates) {
  drivers::TracksFile file = tracks();
  file.region_axes = {"auto", "auto both", "30"};
  const AppConfig config = with_axes_of(file, parse_config(kText, "a.yaml"));
  EXPECT_EQ(config.regions[0].axis_deg, 30.0);
  EXPECT_TRUE(config.regions[1].both_axes);
  EXPECT_EQ(config.regions[1].axis_from, core::AxisFrom::kMotion);
}

TEST_F(TracksAxes, AreFoundWhereTheFileSaysNothing) {
  const AppConfig config = with_axes_of(tracks(), parse_config(kText, "a.yaml"));
  EXPECT_EQ(config.regions[1].axis_from, core::AxisFrom::kMotion);
  EXPECT_EQ(config.regions[1].axis_deg, 90.0);
  EXPECT_EQ(config.regions[0].axis_deg, 90.0);
}

TEST_F(TracksAxes, LeaveADeclaredAxisAlone) {
  const AppConfig config = with_axes_of(tracks(), parse_config(kText, "a.yaml", {"regions.1.axis=u"}));
  EXPECT_EQ(config.regions[1].axis_from, core::AxisFrom::kDeclared);
  EXPECT_EQ(config.regions[1].axis_deg, 0.0);
}

}  // namespace
}  // namespace app
