#include "firmware_app/chain/state/setup_sums.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/support/simulated_structure.h"

namespace {

using test_support::SimulatedStructure;
using ::testing::HasSubstr;

app::SetupSums flight(std::uint64_t seed, double duration_s = 120.0) {
  SimulatedStructure structure;
  structure.seed = seed;
  structure.duration_s = duration_s;
  structure.segment = 256;
  app::SetupSums out;
  out.record = {structure.spectra(), structure.channels()};
  out.view.rate_hz = out.record.sums.rate_hz;
  out.view.scale_mm_per_px = 1.0;
  out.view.channels = out.record.channels;
  out.basis.row_share.assign(out.record.channels.size(), 0.0);
  out.basis.rate_hz = out.record.sums.rate_hz;
  return out;
}

app::ViewTotal total_of(const std::vector<app::SetupSums>& flights) {
  std::uint64_t n_segments = 0;
  for (const app::SetupSums& one : flights) n_segments += one.record.sums.n_segments;
  app::ViewTotal total(n_segments);
  for (const app::SetupSums& one : flights) total.add(one);
  return total;
}

TEST(SetupSums, AreTheSameOutOfTheirBytes) {
  app::SetupSums sums = flight(1);
  sums.record.channels[1].is_witness = true;
  sums.basis.identifier.references = {0, 2};
  sums.from_tracks = {true, 0.65, 0.01, 7, 3, 0, 12.0};
  const auto bytes = app::to_bytes(sums);
  const app::SetupSums back = app::setup_sums_of(bytes);
  EXPECT_EQ(app::to_bytes(back), bytes);
  EXPECT_EQ(back.record.sums.data_sum, sums.record.sums.data_sum);
  EXPECT_EQ(back.record.sums.n_blocks, sums.record.sums.n_blocks);
  EXPECT_TRUE(back.record.channels[1].is_witness);
  EXPECT_EQ(back.from_tracks.n_degrees, 7);
}

TEST(SetupSums, DamagedBytesAreRefused) {
  const auto bytes = app::to_bytes(flight(1));
  EXPECT_THROW((void)app::setup_sums_of({}), std::runtime_error);
  EXPECT_THROW((void)app::setup_sums_of({bytes.data(), bytes.size() - 1}), std::runtime_error);
  auto other = bytes;
  other[0] ^= 1U;
  EXPECT_THROW((void)app::setup_sums_of(other), std::runtime_error);
  app::SetupSums short_of_one = flight(1);
  short_of_one.record.sums.mask_sum.pop_back();
  EXPECT_THROW((void)app::setup_sums_of(app::to_bytes(short_of_one)), std::runtime_error);
}

TEST(SetupSums, OtherViewsAreTold) {
  const app::SetupSums one = flight(1);
  app::SetupSums other = flight(2);
  EXPECT_EQ(app::why_other_view(one, other), "");
  EXPECT_EQ(app::why_other_view(app::without_sums(one), app::without_sums(other)), "");
  other.view.scale_mm_per_px = 1.2;
  EXPECT_THAT(app::why_other_view(one, other), HasSubstr("mm per pixel"));
  other = flight(2);
  other.basis.identifier.max_order = 20;
  EXPECT_THAT(app::why_other_view(one, other), HasSubstr("identified in another way"));
  EXPECT_THROW((void)total_of({one, other}), std::invalid_argument);
}

TEST(SetupSums, TheSameSamplesAreKnownAgain) {
  const app::SetupSums one = flight(1);
  app::SetupSums rounded = one;
  for (auto& value : rounded.record.sums.data_sum) value *= 1.0 + 1e-8;
  EXPECT_TRUE(app::same_samples(app::fingerprint(one.record.sums), app::fingerprint(rounded.record.sums)));
  EXPECT_FALSE(app::same_samples(app::fingerprint(one.record.sums), app::fingerprint(flight(2).record.sums)));
}

TEST(ViewTotal, OfOneFlightIsItsOwnEstimate) {
  const app::SetupSums one = flight(1);
  const core::ModalEstimate own =
      app::ReadoutAwareIdentifier(one.basis, one.record.channels).identify(one.record.sums, {});
  const core::ModalEstimate total = total_of({one}).identify();
  ASSERT_FALSE(own.modes.empty());
  ASSERT_EQ(total.modes.size(), own.modes.size());
  for (std::size_t m = 0; m < own.modes.size(); ++m) {
    EXPECT_EQ(total.modes[m].frequency_hz, own.modes[m].frequency_hz);
    EXPECT_EQ(total.modes[m].frequency_std_hz, own.modes[m].frequency_std_hz);
  }
}

TEST(ViewTotal, OfManyFlightsIsMoreExact) {
  std::vector<app::SetupSums> flights;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) flights.push_back(flight(seed));
  const core::ModalEstimate one = total_of({flights[0]}).identify(), all = total_of(flights).identify();
  ASSERT_FALSE(one.modes.empty());
  ASSERT_FALSE(all.modes.empty());
  ASSERT_TRUE(one.modes[0].frequency_std_hz && all.modes[0].frequency_std_hz);
  EXPECT_LT(*all.modes[0].frequency_std_hz, 0.7 * *one.modes[0].frequency_std_hz);
  EXPECT_EQ(all.n_samples, 8 * one.n_samples);
}

// The readout time estimated from every flight's tracks is weighted by its precision.
TEST(ViewTotal, KnowsTheReadoutTimeAsAllFlightsTogether) {
  app::SetupSums one = flight(1), two = flight(2);
  one.basis.declared = two.basis.declared = {0.02, 0.5};
  one.from_tracks = {true, 0.60, 0.02, 9, 3, 0, 60.0};
  two.from_tracks = {true, 0.66, 0.01, 9, 3, 0, 60.0};
  const core::ModalEstimate estimate = total_of({one, two}).identify();
  ASSERT_TRUE(estimate.readout && estimate.readout->from_tracks);
  EXPECT_NEAR(estimate.readout->from_tracks->readout_s * one.basis.rate_hz, (0.60 + 4.0 * 0.66) / 5.0, 1e-12);
}

}  // namespace
