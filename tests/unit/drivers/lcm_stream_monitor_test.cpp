#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/stream_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/run_identity.h"
#include "drivers/telemetry/sender_watch.h"
#include "tests/support/telemetry_samples.h"

namespace {

using drivers::StreamMonitor;
using drivers::to_message;
using drivers::to_messages;

class StreamMonitorTest : public ::testing::Test {
 protected:
  template <class Message>
  void send(StreamMonitor::Topic topic, Message message, std::int64_t sequence, std::int64_t utc_ns) {
    message.sequence = sequence;
    message.utc_ns = utc_ns;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    monitor_.receive(monitor_.lcm_channel(topic), bytes.data(), bytes.size(), ++now_ns_);
  }
  void send_sample(std::int64_t sequence, std::int64_t utc_ns, const std::string& stream = "tower") {
    send(StreamMonitor::kDisplacement, to_message(tests::sample_displacement(3, 1), {stream, 1}), sequence, utc_ns);
  }
  void send_sample_of(std::uint64_t run_id, std::int64_t sequence, std::int64_t utc_ns) {
    send(StreamMonitor::kDisplacement, to_message(tests::sample_displacement(3, 1), {"tower", 1, run_id}), sequence,
         utc_ns);
  }
  [[nodiscard]] const drivers::ChannelCount& samples() const { return monitor_.count(StreamMonitor::kDisplacement); }

  StreamMonitor monitor_{"TEST"};
  std::int64_t now_ns_ = 0;
};

TEST_F(StreamMonitorTest, CountsTheMessagesMissingBetweenThoseHeard) {
  send_sample(5, 10);
  send_sample(6, 20);
  send_sample(10, 30);
  EXPECT_EQ(samples().received, 3U);
  EXPECT_EQ(samples().gaps, 3U);
  EXPECT_EQ(samples().first_sequence, 5);
  EXPECT_EQ(samples().last_sequence, 10);
}

TEST_F(StreamMonitorTest, KeepsTheNewestReportOfClosingTheLoop) {
  EXPECT_FALSE(monitor_.closure());
  for (const std::uint64_t n : {0U, 1U}) {
    send(StreamMonitor::kClosure, to_message(tests::sample_closure(n + 1, n), {"tower", 1}),
         static_cast<std::int64_t>(n), 10);
  }
  ASSERT_TRUE(monitor_.closure());
  EXPECT_EQ(monitor_.closure()->number, 1);
  EXPECT_EQ(monitor_.closure()->steps.size(), 2U);
}

TEST_F(StreamMonitorTest, TellsALateMessageFromARestart) {
  send_sample(5, 50);
  send_sample(4, 40);
  EXPECT_EQ(samples().out_of_order, 1U);
  EXPECT_EQ(monitor_.history_mm(0).size(), 1U);
  send_sample(0, 60);
  EXPECT_EQ(samples().restarts, 1U);
  EXPECT_EQ(samples().gaps, 0U);
  send_sample(1, 70);
  EXPECT_EQ(samples().last_sequence, 1);
}

TEST_F(StreamMonitorTest, OneWildMessageDoesNotDeafenForGood) {
  send_sample(std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max());
  for (std::int64_t n = 0; n < 20; ++n) send_sample(n, n);
  EXPECT_EQ(samples().restarts, 1U);
  EXPECT_EQ(samples().last_sequence, 19);
  EXPECT_EQ(samples().out_of_order, 8U);
}

TEST_F(StreamMonitorTest, FollowsTheFirstStreamAndOnlyCountsOthers) {
  send_sample(0, 10, "tower");
  send_sample(7, 20, "bridge");
  send_sample(1, 30, "tower");
  EXPECT_EQ(samples().received, 2U);
  EXPECT_EQ(samples().foreign, 1U);
  EXPECT_EQ(samples().gaps, 0U);
}

TEST_F(StreamMonitorTest, TwoSendersWithOneStreamIdAreToldApartAndCounted) {
  for (std::int64_t n = 0; n < 20; ++n) {
    now_ns_ += 50'000'000;
    send_sample_of(0xAAU, 100 + n, 10 * n);
    send_sample_of(0xBBU, n, 10 * n + 5);
  }
  EXPECT_EQ(samples().received, 20U);
  EXPECT_EQ(samples().foreign, 20U);
  EXPECT_EQ(samples().restarts, 0U);
  EXPECT_EQ(samples().gaps, 0U);
  EXPECT_EQ(monitor_.senders().n_senders(), 2U);
  ASSERT_EQ(monitor_.senders().others().size(), 1U);
  EXPECT_EQ(monitor_.senders().others()[0].n_messages, 20U);
  const auto words = monitor_.sender_warnings();
  ASSERT_EQ(words.size(), 1U);
  for (const char* part :
       {"2 runs send as `tower`", "00000000000000aa is shown", "20 messages of run 00000000000000bb"})
    EXPECT_NE(words[0].find(part), std::string::npos) << words[0];
}

TEST_F(StreamMonitorTest, ARestartedServiceIsNoSecondSender) {
  for (std::int64_t n = 0; n < 5; ++n) send_sample_of(0xAAU, n, n);
  now_ns_ += 2'000'000'000;
  send_sample_of(0xBBU, 0, 100);  // it may still be a second sender
  EXPECT_EQ(samples().restarts, 0U);
  now_ns_ += 2'000'000'000;
  send_sample_of(0xBBU, 60, 200);  // the first one is silent
  EXPECT_EQ(samples().restarts, 1U);
  EXPECT_EQ(samples().gaps, 0U) << "losses of a run before it is followed are unknown";
  EXPECT_EQ(monitor_.senders().n_senders(), 1U);
  EXPECT_TRUE(monitor_.sender_warnings().empty());
}

TEST_F(StreamMonitorTest, ARunThatBeginsAfterTheEndOfTheLastOneIsFollowedAtOnce) {
  send_sample_of(0xAAU, 7, 1);
  core::Health last;
  last.state = "finished";
  auto health = to_message(last, {}, {"tower", 1, 0xAAU});
  send(StreamMonitor::kHealth, health, 3, 2);
  send_sample_of(0xBBU, 9, 3);
  EXPECT_EQ(samples().received, 2U);
  EXPECT_EQ(samples().restarts, 1U);
  EXPECT_EQ(monitor_.senders().run_id(), 0xBB);
}

TEST(RunIdentity, IsConstantInAProcessAndNeverZero) {
  EXPECT_NE(drivers::run_identity(), 0U);
  EXPECT_EQ(drivers::run_identity(), drivers::run_identity());
}

TEST(SenderWatch, KeepsABoundedNumberOfSenders) {
  drivers::SenderWatch watch;
  for (std::int64_t id = 1; id <= 100; ++id) (void)watch.note(id, id);
  EXPECT_EQ(watch.others().size(), drivers::SenderWatch::kMost);
  (void)watch.note(1, 1'000'000'000);
  EXPECT_EQ(watch.n_senders(), 1 + drivers::SenderWatch::kMost);
}

TEST_F(StreamMonitorTest, CountsWhatDoesNotDecodeAndIgnoresOtherChannels) {
  const std::string junk = "not a message";
  monitor_.receive("TEST_MODAL", junk.data(), junk.size(), 1);
  monitor_.receive("TEST_MODAL", junk.data(), 0, 1);
  monitor_.receive("OTHER", junk.data(), junk.size(), 1);
  EXPECT_EQ(monitor_.count(StreamMonitor::kModal).undecodable, 2U);
  EXPECT_EQ(monitor_.stream_id(), "");
  send_sample(-1, 10);
  EXPECT_EQ(samples().undecodable, 1U);
}

TEST_F(StreamMonitorTest, AServiceOfAnotherVersionIsToldInWords) {
  auto message = to_message(tests::sample_displacement(3, 1), {"tower", 1});
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  monitor_.receive("TEST_DISPLACEMENT_V2", bytes.data(), bytes.size(), 1);
  EXPECT_EQ(monitor_.other_versions().size(), 1U);
  bytes[3] ^= 0xFFU;
  for (int i = 0; i < 3; ++i) monitor_.receive("TEST_DISPLACEMENT", bytes.data(), bytes.size(), 1);
  ASSERT_EQ(monitor_.other_versions().size(), 2U);
  EXPECT_NE(monitor_.other_versions()[1].find("this service speaks another version"), std::string::npos);
  EXPECT_EQ(samples().undecodable, 4U);
  EXPECT_EQ(samples().received, 0U);
  EXPECT_EQ(samples().n_bytes, 4U * bytes.size());
}

TEST_F(StreamMonitorTest, ExtremeSequencesDoNotOverflow) {
  send_sample(0, 1);
  send_sample(std::numeric_limits<std::int64_t>::max(), 2);
  EXPECT_EQ(samples().gaps, static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()) - 1);
}

TEST_F(StreamMonitorTest, PutsThePartsOfAnEstimateTogetherInOrder) {
  const auto parts = to_messages(tests::sample_estimate(12, 10), tests::sample_channels(12), {"tower", 1});
  ASSERT_GT(parts.size(), 1U);
  for (std::size_t i = parts.size(); i-- > 0;) {
    send(StreamMonitor::kModal, parts[i], static_cast<std::int64_t>(parts.size() - i), 100 - static_cast<int>(i));
  }
  const auto modes = monitor_.modes();
  ASSERT_EQ(modes.size(), 10U);
  EXPECT_EQ(monitor_.parts_heard(), static_cast<int>(parts.size()));
  for (std::size_t i = 1; i < modes.size(); ++i) EXPECT_LT(modes[i - 1]->frequency_hz, modes[i]->frequency_hz);
  EXPECT_EQ(monitor_.channel_name(11), "floor_12.u");
}

TEST_F(StreamMonitorTest, ANewEstimateReplacesAHalfHeardOne) {
  send(StreamMonitor::kModal, to_messages(tests::sample_estimate(12, 10, 0), {}, {"tower", 1}).at(0), 0, 1);
  send(StreamMonitor::kModal, to_messages(tests::sample_estimate(2, 1, 1), {}, {"tower", 1}).at(0), 5, 2);
  EXPECT_EQ(monitor_.modes().size(), 1U);
  EXPECT_EQ(monitor_.estimate()->number, 1);
}

TEST_F(StreamMonitorTest, NoticesTheEndOfAStreamAndItsRestart) {
  const auto say = [&](const char* state, std::int64_t n) {
    send(StreamMonitor::kHealth, to_message(tests::sample_health(state, 1), {}, {"tower", 1}), n, n + 1);
  };
  say("running", 0);
  EXPECT_FALSE(monitor_.is_finished());
  say("fault: camera gone", 1);
  EXPECT_TRUE(monitor_.is_finished());
  say("starting", 2);
  EXPECT_FALSE(monitor_.is_finished());
  say("finished", 3);
  EXPECT_TRUE(monitor_.is_finished());
}

TEST_F(StreamMonitorTest, KeepsABoundedHistoryWithHolesWhereNotSeen) {
  auto sample = tests::sample_displacement(2, 1);
  sample.seen[1] = 0;
  for (std::int64_t n = 0; n < 1500; ++n) {
    send(StreamMonitor::kDisplacement, to_message(sample, {"tower", 1}), n, n + 1);
  }
  EXPECT_EQ(monitor_.history_mm(0).size(), StreamMonitor::kHistory);
  EXPECT_TRUE(std::isnan(monitor_.history_mm(1).back()));
}

}  // namespace
#endif
