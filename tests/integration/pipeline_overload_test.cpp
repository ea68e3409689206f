// Sustained overload, and a stage that hangs: every n-th frame at equal spacing, and a fault that names the stage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <set>
#include <thread>

#include "tests/support/pipeline_rig.h"

namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using tests::CameraScript;
using tests::frames;
using tests::kShortClip;
using tests::Rig;
using tests::too_fast;

TEST(PipelineOverload, KeepsEveryNthFrameAtEqualSpacingAndSaysSo) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "instrumented tracking follows one frame in sixty: too few are left to look at";
#endif
  Rig rig(too_fast(1500), {"spectrum.segment=32", "rt.frame_slots=4"}, kShortClip);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_in, 1500U);
  EXPECT_EQ(outcome.health.frames_in, outcome.health.frames_processed + outcome.health.frames_dropped);
  ASSERT_LT(outcome.health.rate_hz, 25.0);
  const auto stride = static_cast<std::uint64_t>(std::llround(25.0 / outcome.health.rate_hz));
  EXPECT_DOUBLE_EQ(outcome.health.rate_hz, 25.0 / static_cast<double>(stride));
  EXPECT_THAT(outcome.health.warnings, Contains(HasSubstr("overload: only every")));

  // The end of the record is on a grid of one stride, and the estimate uses only such a part. Under load from elsewhere
  // the stride may change once more behind it.
  const auto& samples = rig.heard->samples;
  ASSERT_GT(samples.size(), 5U);
  const std::uint64_t last = samples.back().sequence;
  const std::uint64_t last_stride = samples.back().stride;
  EXPECT_GT(last_stride, 1U);
  std::set<double> rates_hz;
  for (const auto& sample : samples) rates_hz.insert(25.0 / sample.stride);
  for (std::size_t i = samples.size(); i-- > 0 && samples[i].stride == last_stride;) {
    EXPECT_EQ((last - samples[i].sequence) % last_stride, 0U) << samples[i].sequence;
  }
  EXPECT_TRUE(rates_hz.contains(outcome.estimate.rate_hz)) << outcome.estimate.rate_hz;
  EXPECT_LE(static_cast<double>(outcome.estimate.n_samples) * 25.0 / outcome.estimate.rate_hz, 1500.0);
  bool told_old_rate = false;
  for (const auto& estimate : rig.heard->estimates) told_old_rate = told_old_rate || estimate.rate_hz == 25.0;
  EXPECT_TRUE(told_old_rate) << "what was seen before the change is not lost";
}

TEST(PipelineOverload, RandomLossAtTheSourceIsMaskedAndThinsNothing) {
  CameraScript script = frames(600);
  script.is_lost = [](std::uint64_t k) { return k > 0 && (k * 2654435761U) % 1000 < 300; };
  Rig rig(script);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.health.rate_hz, 25.0);
  EXPECT_EQ(outcome.health.frames_dropped, 0U);
  EXPECT_GT(outcome.health.frames_missing, 120U);
}

TEST(PipelineOverload, AStageThatHangsIsNamedWhileItHangsAndCostsNothingAfterwards) {
  CameraScript script = frames(120);
  script.lossless = false;
  script.frame_time = std::chrono::milliseconds(2);
  const auto hang = std::make_shared<std::atomic<bool>>(true);
  script.is_dark = [hang](std::uint64_t k) {  // the camera's capture hangs at this frame
    while (k == 60 && hang->load()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return false;
  };
  Rig rig(script, {"spectrum.segment=32", "rt.stall_s=0.5"}, kShortClip);
  rig.pipeline->start();
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (rig.pipeline->stall().empty() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_THAT(rig.pipeline->stall(), HasSubstr("stage capture: one step has taken"));
  EXPECT_THAT(rig.pipeline->health().state, HasSubstr("stalled: stage capture"));
  hang->store(false);
  const auto outcome = rig.finish();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_in, 120U);
  EXPECT_EQ(outcome.health.state, "finished");
  EXPECT_EQ(rig.pipeline, nullptr);
}

}  // namespace
