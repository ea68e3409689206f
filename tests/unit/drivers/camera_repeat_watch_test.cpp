#include "drivers/camera/recording/repeat_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <random>
#include <set>
#include <vector>

namespace drivers {
namespace {

constexpr int kSide = 64;

// A smooth pattern moved to the right by `at_px`, with white noise of `noise` gray levels.
core::Frame picture(double at_px, double noise, std::mt19937& random) {
  core::Frame frame;
  frame.width_px = frame.height_px = kSide;
  std::normal_distribution<double> scatter(0.0, noise > 0.0 ? noise : 1.0);
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; ++u) {
      const double gray = 128.0 + 60.0 * std::sin(0.3 * (u - at_px)) + 40.0 * std::sin(0.17 * (u - at_px) + 0.1 * v);
      frame.pixels.push_back(static_cast<std::uint8_t>(std::lround(gray + (noise > 0.0 ? scatter(random) : 0.0))));
    }
  }
  return frame;
}

struct Outcome {
  std::vector<std::uint64_t> delivered;  // by sequence
  std::uint64_t n_repeated = 0;
};

// The frames shown[0], shown[1], ... of a film; a frame shown twice is the same picture except for 0.1 gray levels.
Outcome play(const std::vector<std::size_t>& shown, const std::function<double(double)>& place_px, double noise) {
  std::mt19937 random(3);
  std::vector<core::Frame> film;
  for (std::size_t k = 0; k <= shown.back(); ++k)
    film.push_back(picture(place_px(static_cast<double>(k)), noise, random));
  RepeatFilter filter;
  Outcome out;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    core::Frame slot = film[shown[k]];
    if (k > 0 && shown[k] == shown[k - 1]) slot.pixels[k % slot.pixels.size()] ^= 1;
    slot.sequence = k;
    const RepeatFilter::Ready ready = filter.push(slot, false);
    if (ready.held) {
      filter.exchange(slot);
      out.delivered.push_back(slot.sequence);
      filter.exchange(slot);
    }
    if (ready.current) out.delivered.push_back(slot.sequence);
  }
  core::Frame slot;
  if (filter.end(slot)) out.delivered.push_back(slot.sequence);
  out.n_repeated = filter.n_repeated();
  return out;
}

std::vector<std::size_t> all_of(std::size_t n) {
  std::vector<std::size_t> out(n);
  for (std::size_t k = 0; k < n; ++k) out[k] = k;
  return out;
}

double sway_px(double k, double rate_hz) { return 3.0 * std::cos(2.0 * std::numbers::pi * rate_hz * (k + 0.5) / 25.0); }

TEST(RepeatWatch, CallsASingleRepeatAndAFreezeByTheirName) {
  std::vector<std::size_t> shown = all_of(50);
  shown.push_back(49);                                        // one repeat
  for (std::size_t k = 50; k < 100; ++k) shown.push_back(k);  // then on
  for (int i = 0; i < 25; ++i) shown.push_back(99);           // a frozen second
  for (std::size_t k = 125; k < 200; ++k) shown.push_back(k);
  const Outcome outcome = play(
      shown, [](double k) { return sway_px(k, 2.7); }, 2.0);
  EXPECT_EQ(outcome.n_repeated, 26U);
  std::set<std::uint64_t> expected;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (k == 0 || shown[k] != shown[k - 1]) expected.insert(k);
  }
  EXPECT_EQ(std::set<std::uint64_t>(outcome.delivered.begin(), outcome.delivered.end()), expected);
  EXPECT_TRUE(std::is_sorted(outcome.delivered.begin(), outcome.delivered.end()));
}

// Rates at which noiseless motion reverses half-way between two frames, so that they are equal.
TEST(RepeatWatch, AFilmWithoutNoiseThatTurnsBackHasNoRepeats) {
  for (const double rate_hz : {1.0, 2.5, 3.0, 3.125, 4.1}) {
    const Outcome outcome = play(
        all_of(250), [&](double k) { return sway_px(k, rate_hz); }, 0.0);
    EXPECT_EQ(outcome.n_repeated, 0U) << rate_hz;
    EXPECT_EQ(outcome.delivered.size(), 250U) << rate_hz;
  }
}

TEST(RepeatWatch, AFreezeOfAFilmWithoutNoiseIsFound) {
  std::vector<std::size_t> shown = all_of(102);
  for (int i = 0; i < 25; ++i) shown.push_back(101);
  for (std::size_t k = 127; k < 200; ++k) shown.push_back(k);
  const Outcome outcome = play(
      shown, [](double k) { return sway_px(k, 2.9); }, 0.0);
  EXPECT_EQ(outcome.n_repeated, 25U);
}

TEST(RepeatWatch, ASuspectAtTheEndIsDelivered) {
  std::vector<std::size_t> shown = all_of(60);
  shown.push_back(59);
  const Outcome outcome = play(
      shown, [](double k) { return sway_px(k, 2.7); }, 2.0);
  EXPECT_EQ(outcome.n_repeated, 0U) << "nothing after it says more";
  EXPECT_EQ(outcome.delivered.size(), 61U);
}

TEST(RepeatWatch, SaysNothingOfAStillPictureWithoutNoise) {
  RepeatWatch watch;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(watch.push(k % 3 == 0 ? 0.0 : 0.02), RepeatWatch::Finding::kNew);
}

TEST(RepeatWatch, LeavesOutWhatIsKnownToRepeat) {
  std::mt19937 random(1);
  RepeatFilter filter;
  for (int k = 0; k < 60; ++k) {
    core::Frame frame = picture(sway_px(k / 2, 1.3), 1.0, random);
    const RepeatFilter::Ready ready = filter.push(frame, k % 2 == 1);
    EXPECT_EQ(ready.current, k % 2 == 0) << k;
    EXPECT_FALSE(ready.held) << k;
  }
  EXPECT_EQ(filter.n_repeated(), 30U);
}

}  // namespace
}  // namespace drivers
