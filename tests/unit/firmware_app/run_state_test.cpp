#include "firmware_app/chain/state/run_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace app {
namespace {

using ::testing::HasSubstr;

RunState sample_state() {
  RunState state;
  state.config_hash = 42;
  state.rate_hz = 25.0;
  state.scale_mm_per_px = 1.5;
  state.boot_id = "0b1c";
  for (const char* name : {"floor_1", "floor_2"}) {
    core::ChannelInfo channel;
    channel.name = name;
    channel.row_delay_s = 0.01;
    state.channels.push_back(channel);
  }
  state.spectrum = {1, 2, 3};
  state.modes = {4, 5};
  return state;
}

TEST(RunState, ReadsBackWhatWasWritten) {
  const RunState back = run_state_of(to_bytes(sample_state()));
  EXPECT_EQ(to_bytes(back), to_bytes(sample_state()));
  EXPECT_EQ(back.channels.at(1).name, "floor_2");
  EXPECT_EQ(back.boot_id, "0b1c");
  EXPECT_EQ(back.modes, sample_state().modes);
  EXPECT_EQ(why_foreign(back, sample_state()), "");
}

TEST(RunState, BytesCutOffAnywhereAreRefused) {
  const auto bytes = to_bytes(sample_state());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW((void)run_state_of({bytes.data(), n}), std::runtime_error) << n;
}

TEST(RunState, SaysWhatMakesAStateForeign) {
  const RunState now = sample_state();
  const auto reason = [&](auto change) {
    RunState saved = sample_state();
    change(saved);
    return why_foreign(saved, now);
  };
  EXPECT_THAT(reason([](RunState& s) { s.config_hash = 7; }), HasSubstr("configuration"));
  EXPECT_THAT(reason([](RunState& s) { s.rate_hz = 30.0; }), HasSubstr("30 Hz"));
  EXPECT_THAT(reason([](RunState& s) { s.channels.pop_back(); }), HasSubstr("channels"));
  EXPECT_THAT(reason([](RunState& s) { s.channels[0].name = "roof"; }), HasSubstr("roof"));
  EXPECT_THAT(reason([](RunState& s) { s.channels[1].row_delay_s += 2e-4; }), HasSubstr("another view"));
  EXPECT_THAT(reason([](RunState& s) { s.scale_mm_per_px = 1.7; }), HasSubstr("another view"));
  EXPECT_NE(reason([](RunState& s) { s.scale_mm_per_px = std::numeric_limits<double>::quiet_NaN(); }), "");
  EXPECT_EQ(reason([](RunState& s) { s.channels[1].row_delay_s += 5e-5; }), "");
  EXPECT_EQ(reason([](RunState& s) { s.boot_id = "another boot"; }), "") << "a gap of unknown length, not another view";
}

}  // namespace
}  // namespace app
