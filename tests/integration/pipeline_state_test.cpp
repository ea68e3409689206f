// A run that is cut off and one that goes on with what it left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  std::vector<std::string> overrides(const std::string& more = "identification.min_mpc=0.8") const {
    return {"spectrum.segment=64", "state.period_s=2", "state.directory=" + folder.string(), more};
  }
  // Ends with a fault after 300 frames of 25 a second: its state stays.
  app::Pipeline::Outcome cut_off() const {
    CameraScript script = frames(400);
    script.fault_at = 300;
    Rig rig(script, overrides());
    return rig.run();
  }

  fs::path folder = tests::own_folder();
  fs::path file = folder / "hovermodal.state";
};

TEST_F(PipelineState, ARunThatWasCutOffIsGoneOnWithAndItsRecordCounts) {
  const auto before = cut_off();
  EXPECT_THAT(before.fault, HasSubstr("the cable came off"));
  ASSERT_TRUE(fs::exists(file));
  Rig rig(frames(200), overrides());
  const auto after = rig.run();
  EXPECT_EQ(after.fault, "");
  EXPECT_THAT(after.health.warnings, Contains(HasSubstr("goes on with the state in")));
  // 300 frames less one period at most, a masked segment between, 200 frames.
  EXPECT_GE(after.estimate.n_samples, 250U + 64U + 200U);
  EXPECT_LE(after.estimate.n_samples, 300U + 128U + 200U);
  EXPECT_GT(after.estimate.n_segments, before.estimate.n_segments);
  EXPECT_FALSE(fs::exists(file)) << "it ended by itself: the next run is another one";
}

TEST_F(PipelineState, AStateOfAnotherConfigurationIsRefusedAndTheReasonTold) {
  (void)cut_off();
  Rig rig(frames(200), overrides("identification.min_mpc=0.7"));
  const auto after = rig.run();
  EXPECT_THAT(after.health.warnings, Contains(HasSubstr("its configuration was another one")));
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

TEST_F(PipelineState, AFolderThatIsNotThereCostsTheStateAndIsTold) {
  fs::remove_all(folder);
  Rig rig(frames(200), overrides());
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_processed, 200U);
  EXPECT_THAT(outcome.health.warnings, Contains(HasSubstr("could not be kept")));
}

TEST_F(PipelineState, WithoutAFolderNothingIsKeptOrSaid) {
  Rig rig(frames(200));
  const auto outcome = rig.run();
  EXPECT_THAT(outcome.health.warnings, Not(Contains(HasSubstr("state"))));
  EXPECT_FALSE(fs::exists(file));
}

}  // namespace
