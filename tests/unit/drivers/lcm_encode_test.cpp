#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/encode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drivers/telemetry/decode.h"
#include "tests/support/telemetry_samples.h"

namespace {

using drivers::to_message;
using drivers::to_messages;
const drivers::StreamIdentity kIdentity{"tower", 0xFEDCBA9876543210U};

template <class Message>
std::optional<Message> over_the_wire(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return drivers::decode_message<Message>(bytes.data(), bytes.size());
}

TEST(LcmEncode, EveryPartOfTwelveChannelsAndTenModesFitsOneDatagram) {
  const auto parts = to_messages(tests::sample_estimate(12, 10), tests::sample_channels(12), kIdentity);
  std::size_t n_modes = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_LE(parts[i].getEncodedSize(), drivers::kMaxModalPartBytes);
    EXPECT_EQ(parts[i].part, static_cast<int>(i));
    EXPECT_EQ(parts[i].n_parts, static_cast<int>(parts.size()));
    EXPECT_EQ(parts[i].n_structural, 10);
    EXPECT_EQ(parts[i].channel_names.size(), 12U);
    n_modes += parts[i].modes.size();
  }
  EXPECT_EQ(n_modes, 10U);
  EXPECT_GT(parts.size(), 1U);
  RecordProperty("parts", static_cast<int>(parts.size()));
}

TEST(LcmEncode, StaysWithinTheDatagramWithLongNamesReasonsAndRejectedPoles) {
  auto estimate = tests::sample_estimate(12, 10);
  estimate.status = std::string(500, 's');
  for (auto& mode : estimate.modes) mode.reason = std::string(500, 'r');
  estimate.rejected = estimate.modes;
  auto channels = tests::sample_channels(12);
  for (auto& channel : channels) channel.name += std::string(24, 'n');
  const drivers::StreamIdentity identity{std::string(500, 'i'), 1};
  const auto parts = to_messages(estimate, channels, identity);
  std::size_t n_modes = 0;
  for (const auto& part : parts) {
    EXPECT_LE(part.getEncodedSize(), drivers::kMaxModalPartBytes);
    n_modes += part.modes.size();
  }
  EXPECT_EQ(n_modes, 20U);
  EXPECT_FALSE(parts.back().modes.back().is_structural);
}

TEST(LcmEncode, AModeTooLargeForAPartTravelsAlone) {
  const auto parts = to_messages(tests::sample_estimate(200, 3), tests::sample_channels(200), kIdentity);
  ASSERT_EQ(parts.size(), 3U);
  for (const auto& part : parts) EXPECT_EQ(part.n_modes, 1);
}

TEST(LcmEncode, AnEstimateWithoutModesIsOneMessageThatSaysWhy) {
  core::ModalEstimate estimate;
  estimate.status = "record too short";
  const auto parts = to_messages(estimate, {}, kIdentity);
  ASSERT_EQ(parts.size(), 1U);
  const auto back = over_the_wire(parts[0]);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->status, "record too short");
  EXPECT_EQ(back->n_modes, 0);
}

TEST(LcmEncode, ModesComeBackWithTheirNumbers) {
  auto estimate = tests::sample_estimate(6, 2, 3);
  estimate.amendments = {"pixel locking: sin = 0.043 +- 6e-05 px, from frame 8250 on"};
  const auto back = over_the_wire(to_messages(estimate, tests::sample_channels(6), kIdentity).at(0));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->amendments, estimate.amendments);
  EXPECT_EQ(back->stream_id, "tower");
  EXPECT_EQ(static_cast<std::uint64_t>(back->config_hash), kIdentity.config_hash);
  EXPECT_EQ(back->number, 3);
  EXPECT_EQ(back->stream_time_ns, estimate.t_stream_ns);
  ASSERT_EQ(back->modes.size(), 2U);
  EXPECT_EQ(back->modes[1].frequency_hz, estimate.modes[1].frequency_hz);
  EXPECT_FLOAT_EQ(back->modes[1].shape_re[4], static_cast<float>(estimate.modes[1].shape[4].real()));
  EXPECT_FLOAT_EQ(back->modes[1].shape_im[4], static_cast<float>(estimate.modes[1].shape[4].imag()));
  EXPECT_EQ(back->modes[1].shape_std.size(), 6U);
  EXPECT_EQ(back->channel_names.at(5), "floor_6.u");
  const auto& mode = back->modes[1];
  EXPECT_EQ(mode.track_id, 3);
  EXPECT_EQ(mode.n_estimates, 4);
  EXPECT_FLOAT_EQ(mode.first_seen_s, 20.0F);
  EXPECT_FLOAT_EQ(mode.drift_hz_per_s, 0.0005F);
  EXPECT_FLOAT_EQ(mode.drift_std_hz_per_s, 0.0001F);
  EXPECT_EQ(mode.drifts, 1);
  EXPECT_FLOAT_EQ(mode.more_s, 600.0F);
}

TEST(LcmEncode, UnknownNumbersAreNanOrTheSentinelNeverInvented) {
  core::ModalEstimate estimate;
  estimate.modes.resize(1);
  const auto back = over_the_wire(to_messages(estimate, {}, kIdentity).at(0));
  ASSERT_TRUE(back);
  const auto& mode = back->modes.at(0);
  EXPECT_TRUE(std::isnan(mode.frequency_std_hz));
  EXPECT_TRUE(std::isnan(mode.damping_std));
  EXPECT_TRUE(std::isnan(mode.fold_margin));
  EXPECT_EQ(mode.fold_n, hovermodal::mode_t::FOLD_UNKNOWN);
  EXPECT_EQ(mode.n_shape_std, 0);
  EXPECT_EQ(mode.track_id, 0);
  EXPECT_EQ(mode.n_estimates, 0);
  EXPECT_EQ(mode.drifts, 0);
  for (const float unknown : {mode.first_seen_s, mode.drift_hz_per_s, mode.drift_std_hz_per_s, mode.more_s}) {
    EXPECT_TRUE(std::isnan(unknown));
  }
}

TEST(LcmEncode, AReportOfClosingTheLoopComesBackWithItsNumbers) {
  const auto back = over_the_wire(to_message(tests::sample_closure(2, 3), kIdentity));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->number, 3);
  EXPECT_EQ(back->first_frame, 300);
  EXPECT_EQ(back->last_frame, 1799);
  EXPECT_EQ(back->stream_time_ns, 1799 * 40'000'000LL);
  EXPECT_EQ(back->refused, "");
  EXPECT_EQ(back->unit, "px");
  EXPECT_EQ(back->residual_before, 0.0433);
  EXPECT_EQ(back->residual_after, 0.0312);
  EXPECT_EQ(back->n_adopted, 2);
  ASSERT_EQ(back->n_steps, 2);
  EXPECT_EQ(back->steps[0].effect, "readout time");
  EXPECT_EQ(back->steps[0].is_latent, 0);
  EXPECT_EQ(back->steps[0].numbers, "readout = 22.5 +- 0.12 ms, offset = 3 (at a bound, or not fixed by the data)");
  EXPECT_EQ(back->steps[1].is_latent, 1);
  EXPECT_EQ(back->steps[1].meaning, "in region roof, along u, strongest at 3.2 Hz");
  ASSERT_EQ(back->n_changes, 1);
  EXPECT_THAT(back->changes[0], ::testing::HasSubstr("from frame 1875 on taken out, readout time"));
  ASSERT_EQ(back->n_in_force, 1);
  EXPECT_THAT(back->in_force[0], ::testing::HasSubstr("from frame 1875 on"));
}

TEST(LcmEncode, AReportOfClosingTheLoopIsOneDatagramWhateverItHolds) {
  core::closure::ClosureReport report = tests::sample_closure(40);
  report.changes.assign(40, std::string(5000, 'c'));
  report.in_force.assign(40, std::string(5000, 'f'));
  for (std::string* words : {&report.refused, &report.result.unexplained, &report.result.stop_reason,
                             &report.result.level, &report.result.unit})
    words->assign(5000, 'w');
  for (auto& step : report.result.steps) {
    step.effect.assign(300, 'e');
    step.meaning.assign(300, 'm');
    step.parameters.assign(50, {"p", "px", 1.0, 0.1});
  }
  const auto message = to_message(report, {std::string(500, 's'), 1});
  EXPECT_LE(message.getEncodedSize(), drivers::kMaxModalPartBytes);
  const auto back = over_the_wire(message);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->n_adopted, 40);
  EXPECT_GE(back->n_steps, 1);
  EXPECT_LT(back->n_steps, 40);
}

TEST(LcmEncode, AnUnseenDisplacementIsNanNotZero) {
  auto sample = tests::sample_displacement(3, 1);
  sample.seen[1] = 0;
  sample.value_mm[1] = 0.0;
  const auto back = over_the_wire(to_message(sample, kIdentity));
  ASSERT_TRUE(back);
  EXPECT_FALSE(std::isnan(back->value_mm[0]));
  EXPECT_TRUE(std::isnan(back->value_mm[1]));
  EXPECT_TRUE(std::isnan(back->sigma_mm[1]));
  EXPECT_EQ(back->seen[1], 0);
}

TEST(LcmEncode, TracksKeepPositionsIdsAndFlags) {
  const auto tracks = tests::sample_tracks(40, 9);
  const auto back = over_the_wire(to_message(tracks, kIdentity));
  ASSERT_TRUE(back);
  ASSERT_EQ(back->n_points, 40);
  EXPECT_FLOAT_EQ(back->u_px[11], 111.0F);
  EXPECT_EQ(back->id[11], 11);
  EXPECT_EQ(back->region[11], 3);
  EXPECT_EQ(back->seen[10], 0);
  EXPECT_TRUE(std::isnan(back->u_px[10]));
  EXPECT_EQ(back->inlier[14], 0);
}

// A sine of amplitude A has the mean square A^2 / 2, which the density integrates to whatever the window and rate.
TEST(LcmEncode, SpectrumIntegratesToTheMeanSquareOfASine) {
  constexpr int kN = 64;
  constexpr double kAmplitude = 3.0;
  core::CpsdSums sums = tests::sample_sums(1, kN);
  sums.n_segments = 1, sums.weight.sum = 1.0;
  sums.window_power = kN;  // boxcar
  sums.data_sum.assign(static_cast<std::size_t>(sums.n_bins()), {0.0, 0.0});
  for (std::size_t k = 0; k < sums.data_sum.size(); ++k) {
    std::complex<double> x = 0.0;
    for (int t = 0; t < kN; ++t) {
      x += kAmplitude * std::sin(2.0 * std::numbers::pi * 5.0 * t / kN) *
           std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) * t / kN);
    }
    sums.data_sum[k] = std::norm(x);
  }
  const auto messages = to_messages(sums, tests::sample_channels(1), kIdentity);
  ASSERT_EQ(messages.size(), 1U);
  double integral = 0.0;
  for (const float value : messages[0].psd_mm2_per_hz) integral += static_cast<double>(value) * sums.rate_hz / kN;
  EXPECT_NEAR(integral, kAmplitude * kAmplitude / 2.0, 1e-5);
}

TEST(LcmEncode, SpectrumDoublesAllBinsButDcAndNyquistAndPicksTheDiagonal) {
  auto sums = tests::sample_sums(2, 8);
  for (std::size_t k = 0; k < 5; ++k) {
    sums.data_sum[3 * k + 0] = 1.0;
    sums.data_sum[3 * k + 1] = 99.0;
    sums.data_sum[3 * k + 2] = 10.0;
  }
  const auto messages = to_messages(sums, tests::sample_channels(2), kIdentity);
  ASSERT_EQ(messages.size(), 2U);
  const auto& psd = messages[1].psd_mm2_per_hz;
  const double norm = sums.rate_hz * sums.window_power * sums.weight.sum;
  EXPECT_FLOAT_EQ(psd[0], static_cast<float>(10.0 / norm));
  EXPECT_FLOAT_EQ(psd[1], static_cast<float>(20.0 / norm));
  EXPECT_FLOAT_EQ(psd[4], static_cast<float>(10.0 / norm));
  EXPECT_EQ(messages[1].channel_name, "floor_2.u");
}

TEST(LcmEncode, SpectrumBeforeTheFirstSegmentIsUnknownAndBrokenSumsAreRefused) {
  auto sums = tests::sample_sums(1, 8);
  sums.n_segments = 0, sums.weight = {};
  EXPECT_TRUE(std::isnan(to_messages(sums, {}, kIdentity).at(0).psd_mm2_per_hz.at(1)));
  sums.data_sum.pop_back();
  EXPECT_TRUE(to_messages(sums, {}, kIdentity).empty());
}

TEST(LcmEncode, HealthCarriesCountersWarningsStagesAndChannels) {
  const auto back =
      over_the_wire(to_message(tests::sample_health("running", 4), tests::sample_channels(12), kIdentity));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->frames_in, 100);
  EXPECT_EQ(back->warnings.at(0), "real-time priority refused");
  EXPECT_EQ(back->stages.at(1).name, "tracking");
  EXPECT_EQ(back->stages.at(1).worst_step_ns, 3'000'000);
  EXPECT_EQ(back->stages.at(1).p50_step_ns, 1'000'000);
  EXPECT_EQ(back->stages.at(1).p99_step_ns, 2'000'000);
  EXPECT_EQ(back->stages.at(1).p999_step_ns, 2'500'000);
  EXPECT_EQ(back->stages.at(1).cpu_ns, 8'000'000);
  EXPECT_EQ(back->p99_latency_ns, 7);
  EXPECT_EQ(back->host.cpu_temperature_c, 61.5F);
  EXPECT_EQ(back->host.throttled, -1);
  EXPECT_EQ(back->host.disk_left_bytes, 5'000'000'000);
  EXPECT_EQ(back->channels.at(11).name, "floor_12.u");
  ASSERT_EQ(back->n_regions, 2);
  EXPECT_EQ(back->regions.at(0).name, "roof");
  EXPECT_EQ(back->regions.at(0).state, "searching");
  EXPECT_EQ(back->regions.at(0).frames_searching, 7);
  EXPECT_EQ(back->regions.at(1).points_tracked, 29);
}

TEST(LcmEncode, CutsTextBetweenCharactersAndAtAnEmbeddedZero) {
  EXPECT_EQ(drivers::clipped("étage", 1), "");
  EXPECT_EQ(drivers::clipped("étage", 3), "ét");
  EXPECT_EQ(drivers::clipped(std::string_view("ab\0cd", 5), 10), "ab");
  EXPECT_EQ(drivers::clipped("abc", 3), "abc");
}

TEST(LcmEncode, NumbersTooLargeForTheWireSaturateOrBecomeUnknown) {
  EXPECT_EQ(drivers::to_int16(65535), 32767);
  EXPECT_EQ(drivers::to_int32(std::uint64_t{1} << 40U), 2147483647);
  core::ModalEstimate estimate;
  estimate.modes.resize(1);
  estimate.modes[0].fold_n = 100000;
  EXPECT_EQ(to_messages(estimate, {}, kIdentity).at(0).modes[0].fold_n, hovermodal::mode_t::FOLD_UNKNOWN);
}

}  // namespace
#endif
