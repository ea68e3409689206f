// The service's own objects of the run path allocate nothing after construction.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "firmware_app/chain/spectrum_accumulator.h"
#include "firmware_app/report/run_history.h"
#include "tests/support/alloc_guard.h"

namespace app {
namespace {

TEST(RunPathAllocation, AHistoryTakesAnHourWithoutAllocating) {
  RunHistory history(60.0, 4, 2);
  core::DisplacementSample sample;
  sample.value_mm = {1.0, 2.0, 3.0, 4.0}, sample.seen = {1, 1, 1, 0}, sample.scale_mm_per_px = 0.9;
  core::TrackFrame frame;
  for (std::uint32_t i = 0; i < 8; ++i)
    frame.points.push_back({0.0, 0.0, 0.03, i, static_cast<std::uint16_t>(i % 2), true, true});
  {
    const test_support::AllocGuard guard;
    for (std::int64_t k = 0; k < 60 * 3600; ++k) {
      frame.t_start_ns = sample.t_start_ns = k * 16'666'667;
      history.add(frame);
      history.add(sample);
    }
    EXPECT_EQ(guard.n_new(), 0U);
  }
  EXPECT_NEAR(history.duration_s(), 3600.0, 0.1);
  EXPECT_TRUE(history.displacements()[3].empty());
}

// Includes gaps, a correction of positions, one of row delays, and overload.
TEST(RunPathAllocation, SpectraAccumulateWithoutAllocating) {
  core::WelchConfig config;
  config.n_channels = 1;
  config.segment = 32;
  config.rate_hz = 50.0;
  SpectrumAccumulator spectra(config, 1);
  SpectrumSnapshot snapshot{core::WelchCpsd::empty_sums(config)};
  std::vector<core::DisplacementSample> samples(400);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    core::DisplacementSample& sample = samples[k];
    sample.sequence = k < 90 ? k : k + 7;
    sample.t_start_ns = static_cast<std::int64_t>(sample.sequence) * 20'000'000;
    sample.value_mm = {std::sin(0.7 * static_cast<double>(k))}, sample.seen = {1};
    sample.correction_set = k < 150 ? 0 : k < 200 ? 1 : 2;
    sample.record = k < 200 ? 0 : 2;
    sample.stride = k < 300 ? 1 : 2;
  }
  std::size_t n_snapshots = 0;
  {
    const test_support::AllocGuard guard;
    for (const core::DisplacementSample& sample : samples) {
      for (bool is_done = false; !is_done;) {
        is_done = spectra.step(sample);
        if (!spectra.is_due()) continue;
        spectra.take_snapshot(snapshot);
        ++n_snapshots;
      }
    }
    EXPECT_EQ(guard.n_new(), 0U);
  }
  EXPECT_GT(n_snapshots, 10U);
  EXPECT_DOUBLE_EQ(spectra.sums().rate_hz, 25.0);
}

}  // namespace
}  // namespace app
