#include "firmware_app/chain/spectrum_accumulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

namespace app {
namespace {

constexpr int kSegment = 32;
constexpr double kRate_hz = 50.0;

core::WelchConfig config() {
  core::WelchConfig welch;
  welch.n_channels = 1;
  welch.segment = kSegment;
  welch.rate_hz = kRate_hz;
  return welch;
}

core::DisplacementSample sample_at(std::uint64_t frame) {
  core::DisplacementSample sample;
  sample.sequence = frame;
  sample.t_start_ns = std::llround(1e9 * static_cast<double>(frame) / kRate_hz);
  sample.value_mm = {std::sin(0.7 * static_cast<double>(frame)) + std::cos(0.31 * static_cast<double>(frame))};
  sample.sigma_mm = {0.0}, sample.seen = {1}, sample.n_points = {1};
  return sample;
}

// Snapshots and states that become due meanwhile.
std::vector<SpectrumSnapshot> push(SpectrumAccumulator& spectra, const core::DisplacementSample& sample) {
  std::vector<SpectrumSnapshot> out;
  for (bool is_done = false; !is_done;) {
    is_done = spectra.step(sample);
    if (!spectra.is_due()) continue;
    spectra.take_snapshot(out.emplace_back());
  }
  return out;
}

std::vector<SpectrumSnapshot> push(SpectrumAccumulator& spectra, std::uint64_t first, std::uint64_t n,
                                   std::uint64_t step = 1) {
  std::vector<SpectrumSnapshot> out;
  for (std::uint64_t frame = first; frame < first + n; frame += step) {
    core::DisplacementSample sample = sample_at(frame);
    sample.stride = static_cast<std::uint32_t>(step);
    for (SpectrumSnapshot& snapshot : push(spectra, sample)) out.push_back(std::move(snapshot));
  }
  return out;
}

std::vector<std::uint64_t> segments_of(const std::vector<SpectrumSnapshot>& snapshots) {
  std::vector<std::uint64_t> out;
  for (const SpectrumSnapshot& snapshot : snapshots) out.push_back(snapshot.sums.n_segments);
  return out;
}

TEST(SpectrumAccumulator, GivesASnapshotEverySoManyHopsAndOneAtTheEnd) {
  SpectrumAccumulator spectra(config(), 2);
  const auto snapshots = push(spectra, 0, 100);  // hops at 32, 48, 64, 80, 96 samples
  EXPECT_EQ(segments_of(snapshots), (std::vector<std::uint64_t>{1, 2, 4}));
  EXPECT_EQ(snapshots.back().number, 2U);
  EXPECT_EQ(snapshots.back().t_last_ns, sample_at(79).t_start_ns);
  EXPECT_FALSE(snapshots.back().final);
  spectra.finish();
  ASSERT_TRUE(spectra.is_due());
  SpectrumSnapshot last;
  spectra.take_snapshot(last);
  EXPECT_TRUE(last.final);
  EXPECT_EQ(last.sums.n_samples, 100U);
  EXPECT_FALSE(spectra.is_due());
}

TEST(SpectrumAccumulator, ARunBeginsWithASnapshotOfItsFirstSegment) {
  SpectrumAccumulator spectra(config(), 6);
  const auto snapshots = push(spectra, 0, 32 + 12 * 16);
  EXPECT_EQ(segments_of(snapshots), (std::vector<std::uint64_t>{1, 2, 4, 6, 12}));
  EXPECT_EQ(snapshots.front().t_last_ns, sample_at(kSegment - 1).t_start_ns);
}

TEST(SpectrumAccumulator, SumsThatBeginAgainWaitForThePeriod) {
  SpectrumAccumulator spectra(config(), 4);
  (void)push(spectra, 0, 100);
  const auto snapshots = push(spectra, 102, 3 * 96, 3);  // the end of the old sums, then hops 1 ... 5
  EXPECT_EQ(segments_of(snapshots), (std::vector<std::uint64_t>{5, 4}));
}

TEST(SpectrumAccumulator, MasksALostSampleAndRefusesARepeatedOne) {
  SpectrumAccumulator spectra(config(), 1000);
  (void)push(spectra, 0, 10);
  EXPECT_FALSE(spectra.step(sample_at(12))) << "its cell is found, and two are masked before it";
  (void)push(spectra, sample_at(12));
  EXPECT_FALSE(spectra.refused());
  (void)push(spectra, sample_at(12));
  EXPECT_TRUE(spectra.refused());
  EXPECT_EQ(spectra.n_missing(), 2U);
  EXPECT_EQ(spectra.sums().n_samples, 13U);
}

TEST(SpectrumAccumulator, AYearWithoutASampleCostsTwoSegments) {
  SpectrumAccumulator spectra(config(), 1000);
  (void)push(spectra, 0, 40);
  (void)push(spectra, sample_at(static_cast<std::uint64_t>(kRate_hz * 3e7)));
  EXPECT_LE(spectra.sums().n_samples, 40U + 4U * kSegment + 1U);
  EXPECT_GT(spectra.n_missing(), 1'000'000'000U);
}

TEST(SpectrumAccumulator, WhereEveryThirdFrameIsKeptTheOldSumsComeFirstAndNewOnesBegin) {
  SpectrumAccumulator spectra(config(), 1000);
  (void)push(spectra, 0, 100);
  const auto snapshots = push(spectra, 100, 120, 3);
  ASSERT_EQ(snapshots.size(), 1U);
  EXPECT_DOUBLE_EQ(snapshots[0].sums.rate_hz, kRate_hz);
  EXPECT_EQ(snapshots[0].sums.n_samples, 100U);
  EXPECT_DOUBLE_EQ(spectra.sums().rate_hz, kRate_hz / 3.0);
  EXPECT_EQ(spectra.sums().n_samples, 40U);
}

TEST(SpectrumAccumulator, ACorrectedPlaceMasksASegmentAndCorrectedRowDelaysBeginNewSums) {
  SpectrumAccumulator spectra(config(), 1000);
  (void)push(spectra, 0, 100);
  core::DisplacementSample sample = sample_at(100);
  sample.correction_set = 1;
  EXPECT_TRUE(push(spectra, sample).empty());
  EXPECT_EQ(spectra.sums().n_samples, 100U + kSegment + 1U);
  EXPECT_EQ(spectra.n_masked(), static_cast<std::uint64_t>(kSegment));
  sample = sample_at(101);
  sample.correction_set = sample.record = 2;
  const auto snapshots = push(spectra, sample);
  ASSERT_EQ(snapshots.size(), 1U);
  EXPECT_EQ(snapshots[0].correction_set, 1U);
  EXPECT_EQ(snapshots[0].record, 0U);
  EXPECT_EQ(spectra.sums().n_samples, 1U);
  EXPECT_EQ(spectra.n_masked(), static_cast<std::uint64_t>(kSegment)) << "what was masked before still counts";
}

TEST(SpectrumAccumulator, AKeptStateGoesOnToTheSameBits) {
  SpectrumAccumulator whole(config(), 1000), first(config(), 1000), second(config(), 1000);
  first.keep_state(2.0);  // every second of stream time
  StateBytes state{std::vector<std::uint8_t>(first.state_bytes()), 0};
  std::uint64_t n_saved = 0;
  for (std::uint64_t frame = 0; frame < 180; ++frame) {
    if (first.state_is_due() && first.save(state)) n_saved = frame;
    (void)push(first, sample_at(frame));
  }
  ASSERT_EQ(n_saved, 150U);
  ASSERT_TRUE(second.resume({state.bytes.data(), state.n_used}, true));
  (void)push(second, n_saved, 60);
  (void)push(whole, 0, n_saved + 60);
  EXPECT_EQ(second.sums().n_samples, whole.sums().n_samples);
  EXPECT_EQ(second.sums().data_sum, whole.sums().data_sum);
  EXPECT_EQ(second.sums().mask_sum, whole.sums().mask_sum);
}

TEST(SpectrumAccumulator, AnotherAccumulatorsSumsAreGoneOnWithASegmentBetween) {
  SpectrumAccumulator first(config(), 1000), second(config(), 1000);
  (void)push(first, 0, 100);
  second.go_on_from(first);
  (void)push(second, 0, 50);
  EXPECT_EQ(second.sums().n_samples, 100U + kSegment + 50U);
}

}  // namespace
}  // namespace app
