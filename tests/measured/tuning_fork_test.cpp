#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "firmware_app/service/pipeline.h"
#include "tests/support/measured_data.h"
#include "tests/support/pipeline_run.h"

namespace {

// A weighted fork of nominally 64 Hz, filmed at 250 frames/s by a rolling shutter; the container states 50. Both
// prongs.
TEST(MeasuredTuningFork, ItsFrequencyIsFoundWithin3Permille) {
  SKIP_WITHOUT_MEASURED("tuning_forks/fork_64hz_250fps.mp4");
  const auto clip = tests::measured_data_path() / "tuning_forks" / "fork_64hz_250fps.mp4";
  const std::string text = fmt::format(
      "camera: {{source: '{}', rate_hz: 250}}\n"
      "regions:\n  - {{name: left, rect: [276, 64, 50, 80]}}\n  - {{name: right, rect: [340, 64, 50, 80]}}\n"
      "scale: {{adaptive: false}}\ntelemetry: {{lcm_url: ''}}\n",
      clip.string());
  app::Pipeline pipeline(app::parse_config(text, "fork"));
  pipeline.start();
  ASSERT_TRUE(tests::runs_to_its_end(pipeline, std::chrono::seconds(200)));
  const auto outcome = pipeline.join();
  EXPECT_EQ(outcome.fault, "");
  tests::expect_accounted(outcome.health);
  tests::expect_finite(outcome.estimate);
  double nearest_hz = 0.0;
  for (const core::Mode& mode : outcome.estimate.modes) {
    if (std::abs(mode.frequency_hz - 64.0) < std::abs(nearest_hz - 64.0)) nearest_hz = mode.frequency_hz;
  }
  EXPECT_NEAR(nearest_hz, 64.0, 0.003 * 64.0);
  RecordProperty("frequency_hz", fmt::format("{:.4f}", nearest_hz));
}

}  // namespace
