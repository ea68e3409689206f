#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "core/identification/mode_tracker.h"

namespace core {
namespace {

ModalEstimate estimate_at(int k) {
  ModalEstimate estimate;
  estimate.number = static_cast<std::uint64_t>(k);
  estimate.rate_hz = 25.0;
  estimate.duration_s = 60.0 + 20.0 * k;
  estimate.n_samples = static_cast<std::uint64_t>(estimate.duration_s * 25.0);
  estimate.status = "ok";
  Mode mode;
  mode.frequency_hz = mode.apparent_hz = 2.0 + 0.001 * k;
  mode.damping_ratio = 0.01;
  mode.verdict = Verdict::kStructural;
  mode.shape = {0.3, -0.6, 1.0};
  estimate.modes = {mode};
  return estimate;
}

ModeTracker tracker() { return ModeTracker({.row_delay_s = {0.0, 0.001, 0.002}}); }

std::vector<std::uint8_t> state_of(const ModeTracker& tracker) {
  std::vector<std::uint8_t> bytes(tracker.state_bytes());
  StateWriter out(bytes);
  tracker.save(out);
  EXPECT_TRUE(out.ok());
  bytes.resize(out.n_used());
  return bytes;
}

TEST(ModeTrackerState, ARestoredTrackerSaysTheSameAsOneThatWasNeverInterrupted) {
  ModeTracker uninterrupted = tracker();
  ModeTracker interrupted = tracker();
  for (int k = 0; k < 12; ++k) {
    ModalEstimate a = estimate_at(k), b = estimate_at(k);
    uninterrupted.update(a);
    interrupted.update(b);
    ASSERT_EQ(a.modes[0].history.has_value(), b.modes[0].history.has_value()) << k;
    if (a.modes[0].history) {
      EXPECT_EQ(a.modes[0].history->id, b.modes[0].history->id);
      EXPECT_EQ(a.modes[0].history->n_estimates, b.modes[0].history->n_estimates);
      EXPECT_EQ(a.modes[0].history->drift_hz_per_s, b.modes[0].history->drift_hz_per_s);
    }
    const auto bytes = state_of(interrupted);
    interrupted = tracker();
    StateReader in(bytes);
    ASSERT_TRUE(interrupted.restore(in)) << k;
  }
  EXPECT_EQ(interrupted.n_followed(), 1U);
}

TEST(ModeTrackerState, RefusesOtherChannelsAndBytesCutOff) {
  ModeTracker source = tracker();
  for (int k = 0; k < 3; ++k) {
    ModalEstimate estimate = estimate_at(k);
    source.update(estimate);
  }
  const auto bytes = state_of(source);
  ModeTracker other({.row_delay_s = {0.0, 0.0}});
  StateReader whole(bytes);
  EXPECT_FALSE(other.restore(whole));
  EXPECT_EQ(other.n_followed(), 0U);
  for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 50) {
    ModeTracker cut = tracker();
    StateReader in({bytes.data(), n});
    EXPECT_FALSE(cut.restore(in)) << n;
    EXPECT_EQ(cut.n_followed(), 0U);
  }
}

TEST(ModeTrackerState, RefusesShapesThatAreNoNumbers) {
  ModeTracker source = tracker();
  ModalEstimate estimate = estimate_at(0);
  source.update(estimate);
  auto bytes = state_of(source);
  // Of the channel without a delay: kept as it is.
  const double first = 0.3, nan = std::numeric_limits<double>::quiet_NaN();
  const auto* wanted = reinterpret_cast<const std::uint8_t*>(&first);
  const auto found = std::search(bytes.begin(), bytes.end(), wanted, wanted + sizeof first);
  ASSERT_NE(found, bytes.end());
  std::memcpy(&*found, &nan, sizeof nan);
  ModeTracker other = tracker();
  StateReader in(bytes);
  EXPECT_FALSE(other.restore(in));
  EXPECT_EQ(other.n_followed(), 0U);
}

TEST(ModeTrackerState, AfterARestartNewModesGetNewNumbers) {
  ModeTracker modes = tracker();
  ModalEstimate estimate;
  for (int k = 0; k < 3; ++k) modes.update(estimate = estimate_at(k));
  EXPECT_EQ(estimate.modes[0].history->id, 1U);
  modes.restart();
  EXPECT_EQ(modes.n_followed(), 0U);
  for (int k = 0; k < 3; ++k) modes.update(estimate = estimate_at(k));
  EXPECT_EQ(estimate.modes[0].history->id, 2U);
}

}  // namespace
}  // namespace core
