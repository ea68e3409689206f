// An interrupted run, and one that resumes from its state.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "drivers/storage/checkpoint_file.h"
#include "tests/support/pipeline_rig.h"

namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::CameraScript;
using tests::frames;
using tests::Rig;

class PipelineState : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> overrides(const std::string& more = "identification.min_mpc=0.8") const {
    return {"spectrum.segment=64", "state.period_s=2", "state.directory=" + folder.string(), more};
  }
  // Ends with a fault after 300 frames at 25 per second: its state is kept.
  [[nodiscard]] app::Pipeline::Outcome cut_off() const {
    CameraScript script = frames(400);
    script.fault_at = 300;
    script.silent_before = 240, script.n_timeouts = 60;  // 0.3 s, in which an estimate is finished on a busy computer
    Rig rig(script, overrides());
    return rig.run();
  }

  fs::path folder = tests::own_folder();
  fs::path file = folder / "hovermodal.state";
  fs::path keyframe = folder / "hovermodal.keyframe";
};

double value_at(const tests::Heard& heard, std::uint64_t sequence, std::size_t channel) {
  for (const auto& sample : heard.samples) {
    if (sample.sequence == sequence) return sample.value_mm[channel];
  }
  ADD_FAILURE() << "no sample of frame " << sequence;
  return 0.0;
}

TEST_F(PipelineState, ARunThatWasCutOffIsGoneOnWithAndItsRecordCounts) {
  const auto before = cut_off();
  EXPECT_THAT(before.fault, HasSubstr("the cable came off"));
  ASSERT_TRUE(fs::exists(file));
  Rig rig(frames(200), overrides());
  const auto after = rig.run();
  EXPECT_EQ(after.fault, "");
  EXPECT_THAT(after.health.warnings, Contains(HasSubstr("goes on with the state in")));
  // 300 frames minus at most one period, a masked segment, 200 frames.
  EXPECT_GE(after.estimate.n_samples, 250U + 64U + 200U);
  EXPECT_LE(after.estimate.n_samples, 300U + 128U + 200U);
  EXPECT_GT(after.estimate.n_segments, before.estimate.n_segments);
  EXPECT_FALSE(fs::exists(file)) << "it ended by itself: the next run is another one";
}

// The clip is played repeatedly: frame 340 of the second run is frame 40 of the clip.
TEST_F(PipelineState, DisplacementsAreMeasuredFromTheSameKeyframeAsBefore) {
  Rig whole(frames(400), {"spectrum.segment=64"});
  (void)whole.run();
  (void)cut_off();
  ASSERT_TRUE(fs::exists(keyframe));
  CameraScript script = frames(400);
  script.first = 335;
  Rig rig(script, overrides());
  const auto after = rig.run();
  EXPECT_THAT(after.health.warnings, Contains(HasSubstr("measured from the keyframe of the run before")));
  EXPECT_FALSE(fs::exists(keyframe)) << "it ended by itself: the next run is another one";
  constexpr std::size_t kRoof = tests::kChannels - 2;
  double largest = 0.0;
  // The slow rotation of the camera starts anew at frame 335, with two poles at 1 Hz.
  for (std::uint64_t k = 360; k < 400; ++k) {
    const double expected = value_at(*whole.heard, k, kRoof);
    EXPECT_NEAR(value_at(*rig.heard, k, kRoof), expected, 1.0) << k;
    largest = std::max(largest, std::abs(expected));
  }
  EXPECT_GT(largest, 5.0) << "it moves at all";
}

TEST_F(PipelineState, AnotherViewIsSeededAnewAndTheReasonTold) {
  (void)cut_off();
  const std::string bytes = tests::file_text(keyframe);
  ASSERT_GT(bytes.size(), 480U * 270U);
  // The same points, in an image of another scene; hash, number, time, width and height and a count come before it.
  drivers::CheckpointRead read = drivers::read_checkpoint(keyframe.string());
  constexpr std::size_t kPixels = std::size_t{480} * 270;
  for (std::size_t i = 0; i < kPixels; ++i) read.bytes[40 + i] = static_cast<std::uint8_t>((i * i / 7) & 0xFFU);
  ASSERT_EQ(drivers::write_checkpoint(keyframe.string(), read.bytes), "");
  Rig rig(frames(200), overrides());
  const auto after = rig.run();
  EXPECT_THAT(after.health.warnings, Contains(HasSubstr("points are seeded again")));
  EXPECT_THAT(after.health.warnings, Contains(HasSubstr("goes on with the state in")));
  EXPECT_EQ(after.fault, "");
}

TEST_F(PipelineState, ModesKeepTheirNumbers) {
  (void)cut_off();
  Rig rig(frames(200), overrides());
  const auto after = rig.run();
  EXPECT_THAT(after.health.warnings, Not(Contains(HasSubstr("mode tracking starts again"))));
  ASSERT_FALSE(after.estimate.modes.empty());
  bool followed_from_before = false;
  for (const core::Mode& mode : after.estimate.modes) {
    if (!mode.history) continue;
    std::size_t n_here = 0;  // estimates of this run that have it
    for (const core::ModalEstimate& estimate : rig.heard->estimates)
      for (const core::Mode& other : estimate.modes) n_here += other.history && other.history->id == mode.history->id;
    followed_from_before = followed_from_before || mode.history->n_estimates > n_here;
  }
  EXPECT_TRUE(followed_from_before);
}

TEST_F(PipelineState, AStateOfAnotherConfigurationIsRefusedAndTheReasonTold) {
  (void)cut_off();
  Rig rig(frames(200), overrides("identification.min_mpc=0.7"));
  const auto after = rig.run();
  EXPECT_THAT(after.health.warnings, Contains(HasSubstr("its configuration was different")));
  EXPECT_EQ(after.estimate.n_samples, 200U);
}

TEST_F(PipelineState, ADamagedStateIsRefusedAndTheReasonTold) {
  (void)cut_off();
  std::string bytes = tests::file_text(file);
  ASSERT_GT(bytes.size(), 1000U);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(file, std::ios::binary) << bytes;
  Rig rig(frames(200), overrides());
  const auto after = rig.run();
  EXPECT_THAT(after.health.warnings, Contains(HasSubstr("checksum is wrong")));
  EXPECT_EQ(after.estimate.n_samples, 200U);
}

TEST_F(PipelineState, ReadableButSenselessBytesAreRefused) {
  ASSERT_EQ(drivers::write_checkpoint(file.string(), std::vector<std::uint8_t>(500, 0xFF)), "");
  Rig rig(frames(200), overrides());
  const auto outcome = rig.run();
  EXPECT_THAT(outcome.health.warnings, Contains(HasSubstr("is not taken")));
  EXPECT_EQ(outcome.estimate.n_samples, 200U);
}

TEST_F(PipelineState, AFolderThatIsNotThereIsMade) {
  fs::remove_all(folder);
  (void)cut_off();
  EXPECT_TRUE(fs::exists(file));
}

TEST_F(PipelineState, AFolderThatCannotBeMadeCostsTheStateAndIsTold) {
  fs::remove_all(folder);
  std::ofstream(folder) << "a file in its place\n";
  Rig rig(frames(200), overrides());
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_processed, 200U);
  EXPECT_THAT(outcome.health.warnings, Contains(HasSubstr("could not be kept")));
  EXPECT_THAT(outcome.health.warnings, Contains(HasSubstr("the run goes on without state")));
}

TEST_F(PipelineState, WithoutAFolderNothingIsKeptOrSaid) {
  Rig rig(frames(200));
  const auto outcome = rig.run();
  EXPECT_THAT(outcome.health.warnings, Not(Contains(HasSubstr("state"))));
  EXPECT_FALSE(fs::exists(file));
}

}  // namespace
