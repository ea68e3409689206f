#include "core/identification/verdict.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace core {
namespace {

std::vector<ChannelInfo> channels() {
  std::vector<ChannelInfo> list(4);
  for (std::uint16_t c = 0; c < 4; ++c) {
    list[c].region = c;
    list[c].name = "floor" + std::to_string(c);
  }
  list[0].is_base = true;
  return list;
}

const std::vector<int> kOrders{6, 8, 10, 12};

// A cluster that passes all tests; each test changes one property.
PoleCluster flawless() {
  PoleCluster cluster;
  cluster.frequency_hz = cluster.apparent_hz = 3.0;
  cluster.damping_ratio = 0.01;
  cluster.presence = 1.0;
  cluster.representative.mpc = 0.99;
  cluster.representative.shape = {0.02, 0.4, 0.8, 1.0};
  return cluster;
}

Mode judged(const PoleCluster& cluster, const BaseResponse& response = {}) {
  return judge(cluster, response, channels(), kOrders, VerdictRules{});
}

TEST(Verdict, AFlawlessClusterIsStructural) {
  const Mode mode = judged(flawless());
  EXPECT_EQ(mode.verdict, Verdict::kStructural) << mode.reason;
  EXPECT_EQ(mode.frequency_hz, 3.0);
  EXPECT_EQ(mode.damping_ratio, 0.01);
  EXPECT_EQ(mode.mpc, 0.99);
  EXPECT_EQ(mode.presence, 1.0);
  EXPECT_EQ(mode.shape.size(), 4U);
  EXPECT_FALSE(mode.fold_n.has_value());
  EXPECT_FALSE(mode.reason.empty());
}

TEST(Verdict, DampingOutsideItsLimitsIsNumerical) {
  for (const double zeta : {-0.05, 0.3}) {
    PoleCluster cluster = flawless();
    cluster.damping_ratio = zeta;
    const Mode mode = judged(cluster);
    EXPECT_EQ(mode.verdict, Verdict::kNumerical);
    EXPECT_NE(mode.reason.find("damping"), std::string::npos) << mode.reason;
  }
}

TEST(Verdict, ScatterBelowZeroDampingIsForgiven) {
  PoleCluster cluster = flawless();
  cluster.damping_ratio = -0.001;
  EXPECT_EQ(judged(cluster).verdict, Verdict::kStructural);
}

TEST(Verdict, FewCyclesOrFewSamplesLeaveACandidate) {
  VerdictRules rules;
  rules.record_s = 20.0, rules.samples_per_row = 100.0, rules.resolution_hz = 0.05;  // 60 cycles of 3 Hz
  EXPECT_EQ(judge(flawless(), {}, channels(), kOrders, rules).verdict, Verdict::kStructural);
  rules.record_s = 2.0;
  const Mode brief = judge(flawless(), {}, channels(), kOrders, rules);
  EXPECT_EQ(brief.verdict, Verdict::kCandidate);
  EXPECT_EQ(brief.frequency_hz, 3.0);
  EXPECT_NE(brief.reason.find("6.0 cycles"), std::string::npos) << brief.reason;
  EXPECT_NE(brief.reason.find("0.05 Hz"), std::string::npos) << brief.reason;
  rules.record_s = 20.0, rules.samples_per_row = 3.0;
  EXPECT_EQ(judge(flawless(), {}, channels(), kOrders, rules).verdict, Verdict::kCandidate);
}

TEST(Verdict, AboveTheDeclaredHighestFrequencyNothingIsAMode) {
  VerdictRules rules;
  rules.max_frequency_hz = 2.0;
  EXPECT_EQ(judge(flawless(), {}, channels(), kOrders, rules).verdict, Verdict::kNumerical);
  rules.max_frequency_hz = 4.0;
  EXPECT_EQ(judge(flawless(), {}, channels(), kOrders, rules).verdict, Verdict::kStructural);
}

TEST(Verdict, MotionOfOnePartlyMaskedChannelIsNoMode) {
  Mode mode = judged(flawless());
  reject_lone_motion(mode, "floor2", 0.6);
  EXPECT_EQ(mode.verdict, Verdict::kNumerical);
  EXPECT_NE(mode.reason.find("only floor2 moves, and 40 %"), std::string::npos) << mode.reason;
}

TEST(Verdict, AllChannelsAlikeAreTheCamera) {
  PoleCluster cluster = flawless();
  cluster.representative.shape = {0.97, 1.0, 0.99, 1.0};
  EXPECT_EQ(judged(cluster).verdict, Verdict::kCameraMotion);
}

TEST(Verdict, CameraMotionFollowsTheAxesOfTheChannels) {
  std::vector<ChannelInfo> turned = channels();
  turned[2].direction_u = -1.0;  // this channel has the opposite sign: a translation appears negative
  PoleCluster cluster = flawless();
  cluster.representative.shape = {1.0, 1.0, -1.0, 1.0};
  EXPECT_EQ(judge(cluster, {}, turned, kOrders, VerdictRules{}).verdict, Verdict::kCameraMotion);
  EXPECT_NE(judged(cluster).verdict, Verdict::kCameraMotion);
}

TEST(Verdict, ALoneChannelIsNotCalledCameraMotion) {
  PoleCluster cluster = flawless();
  cluster.representative.shape = {1.0};
  EXPECT_EQ(judge(cluster, {}, std::vector<ChannelInfo>(1), kOrders, VerdictRules{}).verdict, Verdict::kStructural);
}

TEST(Verdict, ABaseThatMovesAlongIsAnInputPeak) {
  PoleCluster cluster = flawless();
  cluster.representative.shape = {0.5, 0.4, 0.8, 1.0};
  EXPECT_EQ(judged(cluster).verdict, Verdict::kInputPeak);
  EXPECT_EQ(judged(cluster, {50.0, 5.0}).verdict, Verdict::kInputPeak) << "beyond doubt whatever the response says";
}

TEST(Verdict, AMeasuredInputsPeakIsFollowedAlikeAndCoherentlyWithoutAResonance) {
  VerdictRules rules;
  rules.base_is_input = true;
  PoleCluster cluster = flawless();
  cluster.representative.shape = {0.0, 0.9, 0.95, 1.0};
  BaseResponse peak{.gain = 1.1, .gain_beside = 1.1, .coherence = 0.9};
  const auto judged_so = [&] { return judge(cluster, peak, channels(), kOrders, rules).verdict; };
  EXPECT_EQ(judged_so(), Verdict::kInputPeak);
  peak.coherence = 0.3;
  EXPECT_EQ(judged_so(), Verdict::kStructural) << "the base does not explain it";
  peak.coherence = 0.9, peak.gain = 8.0;
  EXPECT_EQ(judged_so(), Verdict::kStructural) << "the structure answers";
  peak.gain = 1.1, cluster.representative.shape = {0.0, 0.2, 0.6, 1.0};
  EXPECT_EQ(judged_so(), Verdict::kInputPeak) << "all channels move one way, by unequal amounts";
  cluster.representative.shape = {0.0, -0.9, 0.6, 1.0};
  EXPECT_EQ(judged_so(), Verdict::kStructural) << "the channels move against one another";
  cluster.representative.shape = {0.0, 0.9, 0.95, 1.0};
  peak.base_is_known = true, peak.base_peak = 0.1, peak.base_peak_sigma = 0.2;
  EXPECT_EQ(judged_so(), Verdict::kStructural) << "the base's own spectrum has no peak";
  peak.base_peak = 3.0;
  EXPECT_EQ(judged_so(), Verdict::kInputPeak) << "it has one";
  rules.base_is_input = false;
  EXPECT_EQ(judged_so(), Verdict::kStructural) << "the base is an output: its share decides";
}

TEST(Verdict, ABroadPoleThatTheInputExplainsNeedsAPeakOfTheResponse) {
  VerdictRules rules;
  rules.base_is_input = true;
  PoleCluster cluster = flawless();
  cluster.representative.shape = {0.0, -0.9, 0.6, 1.0}, cluster.damping_ratio = 0.04;
  BaseResponse left{.gain = 1.2, .gain_beside = 1.3, .coherence = 0.99};
  const auto judged_so = [&] { return judge(cluster, left, channels(), kOrders, rules).verdict; };
  EXPECT_EQ(judged_so(), Verdict::kInputPeak);
  left.gain = 2.0;
  EXPECT_EQ(judged_so(), Verdict::kStructural) << "the response has a maximum";
  left.gain = 1.2, left.coherence = 0.9;
  EXPECT_EQ(judged_so(), Verdict::kStructural) << "something else moves the structure, too";
  left.coherence = 0.99, cluster.damping_ratio = 0.01;
  EXPECT_EQ(judged_so(), Verdict::kStructural) << "narrow poles are not what is left of a broad peak";
}

TEST(Verdict, ASteadyLineIsAHarmonicUnlessTheCameraMakesIt) {
  PoleCluster cluster = flawless();
  cluster.damping_ratio = 0.0;
  SpectralLineEvidence line;
  line.steady_segments = 11, line.steady_coherence = 0.97;
  const auto judged_so = [&] { return judge(cluster, {}, channels(), kOrders, VerdictRules{}, line); };
  EXPECT_EQ(judged_so().verdict, Verdict::kHarmonic);
  EXPECT_NE(judged_so().reason.find("11 segments (coherence 0.97)"), std::string::npos) << judged_so().reason;
  line.camera_mac = 0.99, line.camera_hz = 90.0;
  EXPECT_EQ(judged_so().verdict, Verdict::kCameraMotion);
}

TEST(Verdict, ASmallBaseShareIsDecidedByTheAnswerToTheBase) {
  PoleCluster cluster = flawless();
  cluster.representative.shape = {0.2, 0.4, 0.8, 1.0};
  BaseResponse peak{.base_peak = 5.0, .base_peak_sigma = 0.5, .base_is_known = true};
  const auto judged_with = [&](double gain, double gain_beside) {
    peak.gain = gain, peak.gain_beside = gain_beside;
    return judged(cluster, peak).verdict;
  };
  EXPECT_EQ(judged_with(10.0, 4.0), Verdict::kStructural) << "a clear local maximum";
  EXPECT_EQ(judged_with(10.0, 12.0), Verdict::kInputPeak) << "no maximum";
  EXPECT_EQ(judged_with(1.0, 0.5), Verdict::kInputPeak) << "hardly an answer";
  peak.resonance = 2.0, peak.resonance_sigma = 0.1, peak.relative = 3.0, peak.relative_without = 1.0;
  EXPECT_EQ(judged_with(1.0, 0.5), Verdict::kStructural) << "a resonance of the response";
  BaseResponse smooth{1.0, 0.5};
  EXPECT_EQ(judged(cluster, smooth).verdict, Verdict::kInputPeak) << "nothing is known of the base's own spectrum";
  smooth.base_is_known = true;
  EXPECT_EQ(judged(cluster, smooth).verdict, Verdict::kStructural) << "the base's own spectrum has no peak";
}

TEST(Verdict, ALargerBaseShareNeedsABaseWithoutAPeak) {
  PoleCluster cluster = flawless();
  cluster.representative.shape = {0.4, 0.4, 0.8, 1.0};
  EXPECT_EQ(judged(cluster, {.base_peak = 0.1, .base_peak_sigma = 0.2, .base_is_known = true}).verdict,
            Verdict::kStructural);
  EXPECT_EQ(judged(cluster, {.base_peak = 3.0, .base_peak_sigma = 0.2, .base_is_known = true}).verdict,
            Verdict::kInputPeak);
  EXPECT_EQ(judged(cluster, {}).verdict, Verdict::kInputPeak) << "no base spectrum was fitted";
  cluster.representative.shape = {0.7, 0.4, 0.8, 1.0};
  EXPECT_EQ(judged(cluster, {.base_peak = 0.1, .base_peak_sigma = 0.2, .base_is_known = true}).verdict,
            Verdict::kInputPeak);
}

TEST(Verdict, APoleOfFewOrdersIsNumerical) {
  PoleCluster rare = flawless();
  rare.presence = 0.75, rare.first_i_order = 3;
  const Mode mode = judged(rare);
  EXPECT_EQ(mode.verdict, Verdict::kNumerical);
  EXPECT_NE(mode.reason.find("75 % of the orders, first at order 12"), std::string::npos) << mode.reason;
}

TEST(Verdict, ALatePoleStaysOpenUntilItsSigmaIsKnown) {
  VerdictRules rules;
  PoleCluster high = flawless(), scarce = flawless();
  high.presence = 13.0 / 15.0, high.first_i_order = 2, scarce.presence = 12.0 / 15.0;
  EXPECT_FALSE(is_late(flawless(), rules));
  for (const PoleCluster& late : {high, scarce}) {
    EXPECT_TRUE(is_late(late, rules));
    EXPECT_EQ(judge(late, {}, channels(), kOrders, rules).verdict, Verdict::kStructural);
  }
  for (const int first : {0, -1}) {
    rules.last_first_i_order = first;
    for (const PoleCluster& late : {high, scarce})
      EXPECT_EQ(judge(late, {}, channels(), kOrders, rules).verdict, Verdict::kNumerical) << "too few channels";
  }
}

TEST(Verdict, AFoldWithoutAClearLeadIsAmbiguous) {
  PoleCluster cluster = flawless();
  cluster.representative.fold_n = -1;
  cluster.representative.fold_margin = 0.6;
  EXPECT_EQ(judged(cluster).verdict, Verdict::kStructural);
  EXPECT_EQ(judged(cluster).fold_n, -1);
  EXPECT_EQ(judged(cluster).fold_margin, 0.6);
  cluster.representative.fold_margin = 0.05;
  EXPECT_EQ(judged(cluster).verdict, Verdict::kAmbiguous);
}

TEST(Verdict, AShakingCameraBeyondTheModesIsNoMode) {
  PoleCluster cluster = flawless();
  const SpectralLineEvidence camera{0.995, 95.0, {}, 0.0};
  const Mode mode = judge(cluster, {}, channels(), kOrders, VerdictRules{}, camera);
  EXPECT_EQ(mode.verdict, Verdict::kCameraMotion);
  EXPECT_NE(mode.reason.find("95.0 Hz"), std::string::npos) << mode.reason;
  const SpectralLineEvidence hardly{0.9, 95.0, {}, 0.0};
  EXPECT_EQ(judge(cluster, {}, channels(), kOrders, VerdictRules{}, hardly).verdict, Verdict::kStructural);
}

TEST(Verdict, ACorrelationThatDoesNotDecayIsASteadyForce) {
  PoleCluster cluster = flawless();
  cluster.damping_ratio = 0.0008;
  const SpectralLineEvidence steady{0.0, 0.0, 0.0001, 0.9}, decays{0.0, 0.0, 0.004, 0.9}, gone{0.0, 0.0, 0.0009, 0.2};
  const Mode mode = judge(cluster, {}, channels(), kOrders, VerdictRules{}, steady);
  EXPECT_EQ(mode.verdict, Verdict::kHarmonic);
  EXPECT_NE(mode.reason.find("steady force"), std::string::npos) << mode.reason;
  EXPECT_EQ(judge(cluster, {}, channels(), kOrders, VerdictRules{}, decays).verdict, Verdict::kStructural);
  EXPECT_EQ(judge(cluster, {}, channels(), kOrders, VerdictRules{}, gone).verdict, Verdict::kStructural);
}

TEST(Verdict, AFoldThatNothingCanTellIsAmbiguous) {
  PoleCluster cluster = flawless();
  cluster.representative.fold_open = true;
  EXPECT_EQ(judged(cluster).verdict, Verdict::kAmbiguous);
}

TEST(VerdictNames, AreThoseOfTheReport) {
  EXPECT_STREQ(to_string(Verdict::kStructural), "structural");
  EXPECT_STREQ(to_string(Verdict::kCameraMotion), "camera_motion");
  EXPECT_STREQ(to_string(Verdict::kInputPeak), "input_peak");
  EXPECT_STREQ(to_string(Verdict::kHarmonic), "harmonic");
  EXPECT_STREQ(to_string(Verdict::kAmbiguous), "ambiguous");
  EXPECT_STREQ(to_string(Verdict::kNumerical), "numerical");
}

TEST(Verdict, TheEdgeOfTheFilterBeforeIsNumerical) {
  VerdictRules rules;
  rules.max_apparent_hz = 2.9;
  const Mode mode = judge(flawless(), {}, channels(), kOrders, rules);
  EXPECT_EQ(mode.verdict, Verdict::kNumerical);
  EXPECT_NE(mode.reason.find("filter edge"), std::string::npos) << mode.reason;
  rules.max_apparent_hz = 3.1;
  EXPECT_EQ(judge(flawless(), {}, channels(), kOrders, rules).verdict, Verdict::kStructural);
}

TEST(Verdict, AccelerometersThatMoveAlikeAreNoCameraMotion) {
  PoleCluster cluster = flawless();
  cluster.representative.shape = {1.0, 1.0, 1.0, 1.0};
  std::vector<ChannelInfo> list = channels();
  list[0].is_base = false;
  EXPECT_EQ(judge(cluster, {}, list, kOrders, {}).verdict, Verdict::kCameraMotion);
  for (ChannelInfo& channel : list) channel.n_integrations = 2;
  EXPECT_EQ(judge(cluster, {}, list, kOrders, {}).verdict, Verdict::kStructural);
}

}  // namespace
}  // namespace core
