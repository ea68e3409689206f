// An accumulator that is saved, restored and continued gives the same bits as one that was never interrupted.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

WelchConfig config_of(double forget_s) {
  WelchConfig config;
  config.n_channels = 3;
  config.segment = 32;
  config.rate_hz = 25.0;
  config.n_blocks = 4;
  config.forget_s = forget_s;
  config.bridge_losses = true;
  config.n_kept_segments = 6;
  return config;
}

struct Source {
  explicit Source(std::uint64_t seed) : random(seed) {}
  void next(std::vector<double>& value, std::vector<std::uint8_t>& seen) {
    std::normal_distribution<double> gaussian;
    for (std::size_t c = 0; c < value.size(); ++c) {
      value[c] = gaussian(random);
      seen[c] = random() % 10 == 0 ? 0 : 1;
    }
  }
  std::mt19937_64 random;
};

std::vector<std::uint8_t> state_of(const WelchCpsd& welch) {
  std::vector<std::uint8_t> bytes(welch.state_bytes());
  StateWriter out(bytes);
  welch.save(out);
  EXPECT_TRUE(out.ok());
  bytes.resize(out.n_used());
  return bytes;
}

bool restore(WelchCpsd& welch, const std::vector<std::uint8_t>& bytes) {
  StateReader in(bytes);
  return welch.restore(in);
}

TEST(WelchState, ARestoredAccumulatorGoesOnToTheSameBits) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const WelchConfig config = config_of(seed % 2 == 0 ? 0.0 : 20.0);
    std::mt19937_64 cuts(seed + 100);
    Source source(seed);
    WelchCpsd uninterrupted(config);
    auto interrupted = std::make_unique<WelchCpsd>(config);
    std::vector<double> value(3);
    std::vector<std::uint8_t> seen(3);
    for (int k = 0; k < 3000; ++k) {
      source.next(value, seen);
      (void)uninterrupted.push(value, seen);
      (void)interrupted->push(value, seen);
      if (cuts() % 200 != 0) continue;
      const auto bytes = state_of(*interrupted);
      interrupted = std::make_unique<WelchCpsd>(config);
      ASSERT_TRUE(restore(*interrupted, bytes));
    }
    uninterrupted.flush();
    interrupted->flush();
    EXPECT_EQ(state_of(uninterrupted), state_of(*interrupted)) << "seed " << seed;
    EXPECT_EQ(uninterrupted.sums().data_sum, interrupted->sums().data_sum);
  }
}

TEST(WelchState, RefusesAnotherConfigurationAndStaysEmpty) {
  WelchCpsd source(config_of(0.0));
  for (int k = 0; k < 200; ++k) (void)source.push_missing();
  const auto bytes = state_of(source);
  auto refuses = [&](WelchConfig config) {
    WelchCpsd other(config);
    EXPECT_FALSE(restore(other, bytes));
    EXPECT_EQ(other.sums().n_samples, 0U);
    EXPECT_EQ(other.sums().n_segments, 0U);
  };
  WelchConfig config = config_of(0.0);
  config.n_channels = 2, refuses(config);
  config = config_of(0.0), config.segment = 34, refuses(config);
  config = config_of(0.0), config.overlap = 0.75, refuses(config);
  config = config_of(0.0), config.rate_hz = 30.0, refuses(config);
  config = config_of(0.0), config.window = WindowKind::kBoxcar, refuses(config);
  refuses(config_of(20.0));
}

TEST(WelchState, RefusesBytesCutOffAnywhere) {
  WelchCpsd source(config_of(0.0));
  for (int k = 0; k < 500; ++k) (void)source.push_missing();
  const auto bytes = state_of(source);
  for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 97) {
    WelchCpsd other(config_of(0.0));
    EXPECT_FALSE(restore(other, {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)})) << n;
    EXPECT_EQ(other.sums().n_samples, 0U);
  }
}

TEST(WelchState, RefusesNumbersThatAreNone) {
  WelchCpsd source(config_of(0.0));
  for (int k = 0; k < 500; ++k) (void)source.push_missing();
  const auto bytes = state_of(source);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int n_refused = 0;
  for (std::size_t at = 0; at + sizeof nan <= bytes.size(); at += sizeof nan) {
    auto other_bytes = bytes;
    std::memcpy(other_bytes.data() + at, &nan, sizeof nan);
    WelchCpsd other(config_of(0.0));
    if (restore(other, other_bytes)) continue;
    ++n_refused;
    EXPECT_EQ(other.sums().n_samples, 0U);
  }
  EXPECT_GT(n_refused, 100);
}

TEST(WelchState, RoomThatIsTooSmallIsToldAndNotOverrun) {
  const WelchCpsd welch(config_of(0.0));
  std::vector<std::uint8_t> bytes(100, 0xEE);
  StateWriter out({bytes.data(), 50});
  welch.save(out);
  EXPECT_FALSE(out.ok());
  EXPECT_EQ(bytes[50], 0xEE);
}

TEST(WelchState, RestartBeginsAnewAtAnotherRate) {
  WelchConfig config = config_of(0.0);
  WelchCpsd used(config);
  Source source(1);
  std::vector<double> value(3);
  std::vector<std::uint8_t> seen(3);
  for (int k = 0; k < 777; ++k) source.next(value, seen), (void)used.push(value, seen);
  used.restart(5.0);
  config.rate_hz = 5.0;
  WelchCpsd fresh(config);
  for (int k = 0; k < 333; ++k) {
    source.next(value, seen);
    EXPECT_EQ(used.push(value, seen), fresh.push(value, seen));
  }
  EXPECT_EQ(state_of(used), state_of(fresh));
}

TEST(TimeGrid, RefusesACellBeforeTheFirst) {
  std::vector<std::uint8_t> bytes(1 + 8 + 8, 0xFF);
  StateReader in(bytes);
  TimeGrid grid(10.0);
  grid.restore(in);
  EXPECT_FALSE(in.ok());
  EXPECT_EQ(grid.last_cell(), 0);
}

TEST(TimeGrid, GoesOnFromARestoredCellAcrossAGap) {
  TimeGrid grid(10.0);
  for (int k = 0; k < 5; ++k) (void)grid.place(1'000'000'000 + k * 100'000'000LL);
  std::vector<std::uint8_t> bytes(64);
  StateWriter out(bytes);
  grid.save(out);
  TimeGrid later(10.0);
  StateReader in(bytes);
  later.restore(in);
  EXPECT_FALSE(later.place(1'400'000'000).accepted) << "already taken";
  const auto placed = later.place(2'000'000'000);
  EXPECT_TRUE(placed.accepted);
  EXPECT_EQ(placed.cell, 10U);
  EXPECT_EQ(placed.n_missing_before, 5U);
}

}  // namespace
}  // namespace core
