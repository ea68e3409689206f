#ifdef HOVERMODAL_WITH_LCM
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/lcm_publisher.h"
#include "drivers/telemetry/lcm_self_test.h"
#include "tests/support/child_process.h"
#include "tests/support/loopback_network.h"
#include "tests/support/places.h"
#include "tests/support/telemetry_samples.h"

namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";
const std::string kSpy = tests::program("hovermodal");

std::filesystem::path test_folder() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(::testing::TempDir()) / "lcm_spy" / info->name();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream in(path);
  return nlohmann::json::parse(in, nullptr, false);
}

// A short run of the service: 300 samples, tracks, spectra and split estimates, health, and the end.
void publish_run(drivers::Publisher& publisher, std::chrono::microseconds pace) {
  const auto channels = tests::sample_channels(12);
  publisher.publish(tests::sample_health("starting", 0));
  for (std::uint64_t n = 0; n < 300; ++n) {
    publisher.publish(tests::sample_displacement(12, n), channels);
    if (n % 25 == 0) publisher.publish(tests::sample_tracks(180, n));
    if (n % 50 == 0) {
      publisher.publish(tests::sample_sums(12, 512), channels);
      publisher.publish(tests::sample_estimate(12, 10, n / 50), channels);
      publisher.publish(tests::sample_closure(2, n / 50));
      publisher.publish(tests::sample_preview(n), {});
      publisher.publish(tests::sample_health("running", n / 25));
    }
    std::this_thread::sleep_for(pace);
  }
  publisher.publish(tests::sample_health("finished", 12));
}

void expect_complete(const nlohmann::json& count, const std::string& prefix, std::uint64_t n_sent) {
  ASSERT_TRUE(count.is_object());
  EXPECT_TRUE(count["final_health"].get<bool>());
  EXPECT_TRUE(count["complete"].get<bool>()) << count.dump(2);
  std::uint64_t received = 0;
  for (const char* topic : drivers::kTopicSuffixes) {
    const auto& channel = count["channels"][prefix + topic];
    EXPECT_EQ(channel["received"], channel["sent"]) << topic;
    EXPECT_EQ(channel["first_sequence"], 0) << topic;
    EXPECT_EQ(channel["last_sequence"].get<std::uint64_t>() + 1, channel["received"].get<std::uint64_t>()) << topic;
    EXPECT_EQ(channel["gaps"], 0) << topic;
    received += channel["received"].get<std::uint64_t>();
  }
  EXPECT_EQ(received, n_sent);
}

TEST(LcmSpy, ASecondProcessHearsEveryMessageInOrder) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto count_file = test_folder() / "count.json";
  drivers::LcmPublisher publisher({kUrl, "HOVERMODAL", "", {"tower", 0xABCDU}});
  EXPECT_EQ(publisher.warning(), "");
  tests::ChildProcess spy({kSpy, "spy", "--once", "--plain", "--count", count_file.string()});
  ASSERT_TRUE(spy.wait_for("listening on")) << spy.output();
  publish_run(publisher, std::chrono::milliseconds(2));
  EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
  EXPECT_EQ(publisher.messages_failed(), 0U);
  expect_complete(read_json(count_file), "HOVERMODAL", publisher.messages_sent());
  for (const char* text : {"1.5000", "structural", "#3 ", "20s", "2.00*", "floor_12.u", "identification", "worst ms",
                           "real-time priority refused", "finished", "s ago", "residual 0.0433 -> 0.0312 px",
                           "readout time: readout = 22.5 +- 0.12 ms"}) {
    EXPECT_NE(spy.output().find(text), std::string::npos) << text << " in\n" << spy.output();
  }
}

TEST(LcmSpy, AnEventLogReadsBackWholeWithoutANetwork) {
  const auto folder = test_folder();
  const auto log = folder / "run.lcm";
  std::uint64_t n_sent = 0;
  {
    drivers::LcmPublisher publisher({"", "HOVERMODAL", log.string(), {"tower", 1}});
    publish_run(publisher, {});
    n_sent = publisher.messages_sent();
  }
  const auto count_file = folder / "count.json";
  tests::ChildProcess spy({kSpy, "spy", "--url", "file://" + log.string() + "?speed=0", "--plain", "--once", "--count",
                           count_file.string()});
  EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
  expect_complete(read_json(count_file), "HOVERMODAL", n_sent);
}

TEST(LcmSpy, InspectShowsEveryStageWithItsRateLatenciesAndTheComputer) {
  const auto log = test_folder() / "run.lcm";
  {
    drivers::LcmPublisher publisher({"", "HOVERMODAL", log.string(), {"tower", 1}});
    publish_run(publisher, {});
  }
  tests::ChildProcess inspect({kSpy, "inspect", "--url", "file://" + log.string() + "?speed=0", "--plain", "--once"});
  EXPECT_EQ(inspect.wait_for_exit(), 0) << inspect.output();
  for (const char* text :
       {"stream tower", "finished", "CPU 61.5 C", "disk 5000 MB left", "p99.9", "capture", "tracking", "spectrum",
        "identification", "publish", "3.000", "real-time priority refused"}) {
    EXPECT_NE(inspect.output().find(text), std::string::npos) << text << " in\n" << inspect.output();
  }
}

TEST(LcmSpy, ALogPlayerReplaysEveryMessage) {
  constexpr const char* kPlayer = "/usr/bin/lcm-logplayer";
  if (!std::filesystem::exists(kPlayer)) GTEST_SKIP() << "needs lcm-logplayer (Debian: liblcm-bin)";
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto folder = test_folder();
  const auto log = folder / "run.lcm";
  const auto count_file = folder / "count.json";
  std::uint64_t n_sent = 0;
  {
    drivers::LcmPublisher publisher({"", "HOVERMODAL", log.string(), {"tower", 1}});
    publish_run(publisher, std::chrono::milliseconds(2));
    n_sent = publisher.messages_sent();
  }
  tests::ChildProcess spy({kSpy, "spy", "--once", "--plain", "--count", count_file.string()});
  ASSERT_TRUE(spy.wait_for("listening on")) << spy.output();
  tests::ChildProcess player({kPlayer, std::string("--lcm-url=") + kUrl, log.string()});
  EXPECT_EQ(player.wait_for_exit(), 0) << player.output();
  EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
  expect_complete(read_json(count_file), "HOVERMODAL", n_sent);
}

TEST(LcmSpy, NetworkAndLogCarryTheSameMessages) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto folder = test_folder();
  const auto log = folder / "run.lcm";
  std::uint64_t n_sent = 0;
  tests::ChildProcess live(
      {kSpy, "spy", "--once", "--plain", "--prefix", "BOTH.1", "--count", (folder / "live.json").string()});
  ASSERT_TRUE(live.wait_for("listening on")) << live.output();
  {
    drivers::LcmPublisher publisher({kUrl, "BOTH.1", log.string(), {"tower", 1}});
    publish_run(publisher, std::chrono::milliseconds(2));
    n_sent = publisher.messages_sent();
  }
  EXPECT_EQ(live.wait_for_exit(), 0) << live.output();
  tests::ChildProcess replayed({kSpy, "spy", "--url", "file://" + log.string() + "?speed=0", "--plain", "--once",
                                "--prefix", "BOTH.1", "--count", (folder / "log.json").string()});
  EXPECT_EQ(replayed.wait_for_exit(), 0) << replayed.output();
  expect_complete(read_json(folder / "live.json"), "BOTH.1", n_sent);
  EXPECT_EQ(read_json(folder / "live.json"), read_json(folder / "log.json"));
}

hovermodal::health_t hostile_health(const char* state, std::int64_t sequence) {
  auto evil = tests::sample_health(state, 1);
  evil.warnings = {"\x1b[31mred\xff\xfe"};
  evil.rate_hz = 1e300;
  auto message = drivers::to_message(evil, tests::sample_channels(4), {"tower\x1b[2J", 1});
  message.sequence = sequence;
  message.utc_ns = sequence;
  return message;
}

template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

TEST(LcmSpy, SurvivesHostileMessagesAndCountsThem) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto count_file = test_folder() / "count.json";
  tests::ChildProcess spy({kSpy, "spy", "--once", "--plain", "--count", count_file.string()});
  ASSERT_TRUE(spy.wait_for("listening on")) << spy.output();
  const std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm(lcm_create(kUrl), &lcm_destroy);
  ASSERT_TRUE(lcm);
  const auto send = [&](const char* channel, const std::vector<std::uint8_t>& bytes) {
    lcm_publish(lcm.get(), channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  std::mt19937 random(3);
  const auto bytes = encoded(hostile_health("running \x1b[2J\x1b]0;owned\x07", 0));
  send("HOVERMODAL_HEALTH", bytes);
  for (int i = 0; i < 300; ++i) {
    auto mutated = bytes;
    for (int k = 0; k < 4; ++k) mutated[8 + random() % (mutated.size() - 8)] = static_cast<std::uint8_t>(random());
    send("HOVERMODAL_HEALTH", mutated);
    send("HOVERMODAL_MODAL", {mutated.begin(), mutated.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size())});
  }
  // Several, because a mutated message may have claimed a sequence and a time far ahead.
  for (int i = 1; i <= 20; ++i) send("HOVERMODAL_HEALTH", encoded(hostile_health("finished", i)));
  EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
  EXPECT_EQ(spy.output().find('\x1b'), std::string::npos);
  EXPECT_EQ(read_json(count_file)["channels"]["HOVERMODAL_MODAL"]["undecodable"], 300);
}

TEST(LcmSpy, ASignalEndsItWellAndTheCountIsWritten) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto count_file = test_folder() / "count.json";
    tests::ChildProcess spy({kSpy, "spy", "--once", "--plain", "--count", count_file.string()});
    ASSERT_TRUE(spy.wait_for("listening on")) << spy.output();
    spy.signal(signal);
    EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
    EXPECT_FALSE(read_json(count_file)["complete"].get<bool>());
  }
}

TEST(LcmSpy, OnceWithoutAnEndIsAFailureThatStillWritesItsCount) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto count_file = test_folder() / "count.json";
  tests::ChildProcess spy({kSpy, "spy", "--once", "--plain", "--seconds", "0.3", "--count", count_file.string()});
  EXPECT_EQ(spy.wait_for_exit(), 1) << spy.output();
  EXPECT_FALSE(read_json(count_file)["final_health"].get<bool>());
}

TEST(LcmSpy, EndsAfterSecondsWithoutError) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  tests::ChildProcess spy({kSpy, "spy", "--plain", "--seconds", "0.3"});
  EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
}

TEST(LcmSpy, RefusesAWrongUrlAsUsage) {
  tests::ChildProcess spy({kSpy, "spy", "--url", "udpm://10.0.0.1:7667"});
  EXPECT_EQ(spy.wait_for_exit(), 2) << spy.output();
  EXPECT_NE(spy.output().find("multicast address"), std::string::npos) << spy.output();
}

TEST(LcmSpy, RefusesACountFileThatCannotBeWritten) {
  const auto folder = test_folder();
  tests::ChildProcess spy({kSpy, "spy", "--count", (folder / "missing" / "count.json").string()});
  EXPECT_EQ(spy.wait_for_exit(), 1) << spy.output();
}

}  // namespace
#endif
