#include "drivers/telemetry/publisher_factory.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

std::string refusal(const drivers::LcmOptions& options) {
  try {
    static_cast<void>(drivers::make_publisher(options));
  } catch (const std::exception& e) {
    return e.what();
  }
  return {};
}

TEST(PublisherFactory, GivesAPublisherOfNothingWhenNothingIsAskedFor) {
  std::string warning = "old";
  const auto publisher = drivers::make_publisher({"", "HOVERMODAL", "", {}}, &warning);
  EXPECT_TRUE(publisher->publish(core::Health{}));
  EXPECT_EQ(publisher->messages_sent(), 0U);
  EXPECT_EQ(warning, "");
}

}  // namespace

#ifndef HOVERMODAL_WITH_LCM
TEST(PublisherFactory, WithoutLcmSaysHowToGetIt) { EXPECT_NE(refusal({}).find("liblcm-dev"), std::string::npos); }
#else

#include <lcm/eventlog.h>

#include <filesystem>
#include <map>
#include <memory>

#include "drivers/telemetry/decode.h"
#include "drivers/telemetry/lcm_publisher.h"
#include "hovermodal/displacement_t.hpp"
#include "hovermodal/health_t.hpp"
#include "hovermodal/modal_estimate_t.hpp"
#include "tests/support/telemetry_samples.h"

namespace {

struct Event {
  std::string channel;
  std::vector<std::uint8_t> data;
  std::int64_t timestamp_us = 0;
};

std::vector<Event> read_log(const std::string& path) {
  std::vector<Event> out;
  const std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)> log(lcm_eventlog_create(path.c_str(), "r"),
                                                                             &lcm_eventlog_destroy);
  if (!log) return out;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log.get())) {
    const auto* bytes = static_cast<const std::uint8_t*>(event->data);
    out.push_back({event->channel, {bytes, bytes + event->datalen}, event->timestamp});
    lcm_eventlog_free_event(event);
  }
  return out;
}

class LcmPublisherTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) / "lcm_publisher" / info->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  [[nodiscard]] std::string log() const { return (folder_ / "run.lcm").string(); }
  [[nodiscard]] drivers::LcmOptions log_only() const { return {"", "TEST", log(), {"tower", 7}}; }

  std::filesystem::path folder_;
};

TEST_F(LcmPublisherTest, NumbersEveryChannelWithoutAGapAndCountsWhatItSent) {
  const auto channels = tests::sample_channels(12);
  std::map<std::string, std::int64_t> expected;
  {
    drivers::LcmPublisher publisher(log_only());
    for (std::uint64_t n = 0; n < 20; ++n) {
      EXPECT_TRUE(publisher.publish(tests::sample_displacement(12, n), channels));
      if (n % 5 == 0) {
        EXPECT_TRUE(publisher.publish(tests::sample_tracks(50, n)));
      }
      if (n % 10 == 0) {
        EXPECT_TRUE(publisher.publish(tests::sample_estimate(12, 10, n), channels));
      }
      if (n % 10 == 0) {
        EXPECT_TRUE(publisher.publish(tests::sample_sums(3, 64), channels));
        EXPECT_TRUE(publisher.publish(tests::sample_closure(2, n)));
        EXPECT_TRUE(publisher.publish(tests::sample_preview(n), {core::Region{}}));
      }
    }
    EXPECT_TRUE(publisher.publish(tests::sample_health("finished", 1)));
    EXPECT_EQ(publisher.messages_failed(), 0U);
    EXPECT_EQ(publisher.messages_sent(), read_log(log()).size());  // health has flushed the log
  }
  std::map<std::string, std::int64_t> next;
  for (const auto& event : read_log(log())) {
    ++next[event.channel];
    if (event.channel == "TEST_DISPLACEMENT") {
      const auto message = drivers::decode_message<hovermodal::displacement_t>(event.data.data(), event.data.size());
      ASSERT_TRUE(message);
      EXPECT_EQ(message->sequence, next[event.channel] - 1);
      EXPECT_EQ(message->stream_id, "tower");
      EXPECT_EQ(message->config_hash, 7);
      EXPECT_EQ(message->utc_ns / 1000, event.timestamp_us);
    }
    if (event.channel == "TEST_MODAL") {
      const auto message = drivers::decode_message<hovermodal::modal_estimate_t>(event.data.data(), event.data.size());
      ASSERT_TRUE(message);
      EXPECT_EQ(message->sequence, next[event.channel] - 1);
    }
    if (event.channel == "TEST_HEALTH") {
      const auto message = drivers::decode_message<hovermodal::health_t>(event.data.data(), event.data.size());
      ASSERT_TRUE(message);
      for (const auto& count : message->counts) expected[count.lcm_channel] = count.n_sent;
      EXPECT_EQ(message->channels.size(), 12U);
    }
  }
  EXPECT_EQ(next, expected);
  EXPECT_EQ(next.size(), drivers::kTopics);
}

TEST_F(LcmPublisherTest, CountsASpectrumItCannotReadAsFailed) {
  drivers::LcmPublisher publisher(log_only());
  core::CpsdSums broken = tests::sample_sums(2, 16);
  broken.data_sum.clear();
  EXPECT_FALSE(publisher.publish(broken, {}));
  EXPECT_EQ(publisher.messages_failed(), 1U);
  EXPECT_EQ(publisher.messages_sent(), 0U);
}

TEST_F(LcmPublisherTest, AFullDiskIsAFailedMessage) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  drivers::LcmPublisher publisher({"", "TEST", "/dev/full", {}});
  EXPECT_FALSE(publisher.publish(tests::sample_health("running", 1)));
  EXPECT_EQ(publisher.messages_failed(), 1U);
}

TEST_F(LcmPublisherTest, RefusesALogThatCannotBeWrittenAndSaysWhich) {
  const std::string path = (folder_ / "missing" / "run.lcm").string();
  const std::string text = refusal({"", "TEST", path, {}});
  EXPECT_NE(text.find(path), text.npos) << text;
  EXPECT_NE(text.find("No such file"), text.npos) << text;
  EXPECT_NE(refusal({"", "TEST", folder_.string(), {}}).find("cannot be written"), std::string::npos);
}

TEST_F(LcmPublisherTest, RefusesAWrongUrlOrPrefix) {
  EXPECT_NE(refusal({"udpm://10.0.0.1:7667", "TEST", "", {}}).find("multicast"), std::string::npos);
  EXPECT_NE(refusal({"", "TE ST", log(), {}}).find("TE ST"), std::string::npos);
}

TEST_F(LcmPublisherTest, ChannelNamesReachHealthOnceKnown) {
  {
    drivers::LcmPublisher publisher(log_only());
    EXPECT_TRUE(publisher.publish(tests::sample_health("starting", 0)));
    EXPECT_TRUE(publisher.publish(tests::sample_displacement(3, 0), tests::sample_channels(3)));
    EXPECT_TRUE(publisher.publish(tests::sample_health("running", 1)));
  }
  const auto events = read_log(log());
  ASSERT_EQ(events.size(), 3U);
  const auto decode = [&](std::size_t i) {
    return drivers::decode_message<hovermodal::health_t>(events[i].data.data(), events[i].data.size());
  };
  EXPECT_EQ(decode(0)->n_channels, 0);
  EXPECT_EQ(decode(2)->channels.at(2).name, "floor_3.u");
}

}  // namespace
#endif
