#include "firmware_app/service/stages/checkpoint_stage.h"

#include <gtest/gtest.h>

#include "drivers/storage/checkpoint_file.h"
#include "tests/support/test_clip.h"

namespace app {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(CheckpointStage, ModesOfAResumedRunAreWrittenUntilAnEstimateReplacesThem) {
  const std::string path = (test_support::fresh_folder() / "hovermodal.state").string();
  rt::TripleBuffer<StateBytes> spectrum(StateBytes{Bytes(8), 0}), modes(StateBytes{Bytes(8), 0});
  CheckpointStage stage(spectrum, modes, RunState{}, path);
  const auto modes_in_file = [&](rt::TripleBuffer<StateBytes>* newest, Bytes bytes) {
    if (newest != nullptr) newest->back() = {bytes, bytes.size()}, newest->publish();
    spectrum.back() = {Bytes{1, 2, 3}, 3};
    spectrum.publish();
    EXPECT_EQ(stage.step(), rt::StepStatus::kWorked);
    EXPECT_EQ(stage.failure(), "");
    return run_state_of(drivers::read_checkpoint(path).bytes).modes;
  };
  stage.go_on_with({7, 8, 9});
  EXPECT_EQ(modes_in_file(nullptr, {}), (Bytes{7, 8, 9})) << "killed here, the next run has them";
  EXPECT_EQ(modes_in_file(&modes, {4, 5}), (Bytes{4, 5}));
}

}  // namespace
}  // namespace app
