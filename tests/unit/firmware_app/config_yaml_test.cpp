#include "firmware_app/config/config_yaml.h"

#include <gtest/gtest.h>

#include "firmware_app/config/config_table.h"

namespace app {
namespace {

const char* const kText = R"(
method: paper
camera: {driver: synthetic, source: "a: \"b\" #c.mp4", rate_hz: 23.976023976023978, readout_ms: -12.3, mount_rpy_deg: [0, 1.5, -90], synthetic: {seed: 7}}
calibration: {fx: 574.4, fy: 574.5, cx: 359.5, cy: 239.5, model: radtan, distortion: [-0.1, 0.02, 1e-05, 0, 0]}
regions:
  - {name: base, rect: [10, 20, 30.5, 40], role: base}
  - {name: roof, rect: [10, 120, 30, 40], axis: both}
scale: {lengths: [[1, 2, 3, 400, 5.25], [1, 2, 3, 404, 7]]}
identification: {references: [roof.u, base]}
closure: {adopt: auto, window_s: 60, period_s: 30, delay_s: 15}
telemetry: {lcm_url: "", stream_id: bridge_7}
rt: {priority: 5}
report: {notes: ["place: Wien, \"am Fluss\"", wind], title: "a: b"}
)";

TEST(ConfigYaml, ReadsBackToTheSameValues) {
  const AppConfig config = parse_config(kText, "a.yaml");
  const std::string yaml = config_yaml(config);
  const AppConfig again = parse_config(yaml, "again.yaml");
  EXPECT_EQ(canonical_text(config), canonical_text(again)) << yaml;
  EXPECT_EQ(config.hash, again.hash);
  EXPECT_EQ(again.telemetry.stream_id, "bridge_7");
  EXPECT_EQ(again.telemetry.lcm_url, "");
  EXPECT_EQ(again.rt.priority, 5);
  EXPECT_EQ(again.report.notes, (std::vector<std::string>{"place: Wien, \"am Fluss\"", "wind"}));
  EXPECT_EQ(again.report.title, "a: b");
  EXPECT_EQ(config_yaml(again), yaml);
}

TEST(ConfigYaml, LeavesDefaultsOut) {
  const AppConfig config =
      parse_config("camera: {source: a.mp4, rate_hz: 25}\nregions: [{name: roof, rect: [1, 2, 30, 40]}]\n", "a.yaml");
  EXPECT_EQ(config_yaml(config),
            "camera:\n  source: \"a.mp4\"\n  rate_hz: 25\nregions:\n  - {name: \"roof\", rect: [1, 2, 30, 40]}\n");
}

}  // namespace
}  // namespace app
