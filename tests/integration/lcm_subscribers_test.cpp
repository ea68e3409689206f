#ifdef HOVERMODAL_WITH_LCM
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "drivers/telemetry/lcm_publisher.h"
#include "tests/support/child_process.h"
#include "tests/support/loopback_network.h"
#include "tests/support/places.h"
#include "tests/support/telemetry_samples.h"

namespace {

using ::testing::HasSubstr;

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";

std::filesystem::path own_folder() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(::testing::TempDir()) / "lcm_subscribers" / info->name();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

// An estimate in several parts among samples, tracks that LCM sends in fragments, and the end.
void publish_run(drivers::Publisher& publisher) {
  const auto channels = tests::sample_channels(12);
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
  publisher.publish(tests::sample_health("running", 0));
  for (std::uint64_t n = 0; n < 20; ++n, pause()) publisher.publish(tests::sample_displacement(12, n), channels);
  publisher.publish(tests::sample_tracks(400, 1));
  publisher.publish(tests::sample_sums(12, 512), channels);
  publisher.publish(tests::sample_estimate(12, 10, 3), channels);
  pause();
  publisher.publish(tests::sample_health("finished", 25));
}

std::vector<std::string> python_subscriber() {
  return {"/usr/bin/python3", tests::source_path("tools/examples/subscribe.py"), "--types",
          tests::program("../python")};
}

void expect_modes(const std::string& output) {
  for (const char* text : {"estimate 3 of tower: ok", "1.5000 +- 0.0100 Hz  damping  1.00 +- 0.20 %", "15.0000 +-",
                           "finished: ", " 0 not understood"}) {
    EXPECT_THAT(output, HasSubstr(text));
  }
}

TEST(LcmSubscribers, TheCppExamplePrintsEveryModeOfAnEstimateInParts) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  drivers::LcmPublisher publisher({kUrl, "HOVERMODAL", "", {"tower", 1}});
  tests::ChildProcess example({tests::program("subscribe"), "--seconds", "60"});
  ASSERT_TRUE(example.wait_for("listening on")) << example.output();
  publish_run(publisher);
  EXPECT_EQ(example.wait_for_exit(), 0) << example.output();
  expect_modes(example.output());
}

TEST(LcmSubscribers, ThePythonExampleNeedsNothingButPython) {
  if (!std::filesystem::exists("/usr/bin/python3")) GTEST_SKIP() << "needs python3";
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  drivers::LcmPublisher publisher({kUrl, "HOVERMODAL", "", {"tower", 1}});
  auto command = python_subscriber();
  command.insert(command.end(), {"--seconds", "60"});
  tests::ChildProcess example(command);
  ASSERT_TRUE(example.wait_for("listening on")) << example.output();
  publish_run(publisher);
  EXPECT_EQ(example.wait_for_exit(), 0) << example.output();
  expect_modes(example.output());
}

TEST(LcmSubscribers, ThePythonReceiverPutsFragmentsTogether) {
  if (!std::filesystem::exists("/usr/bin/python3")) GTEST_SKIP() << "needs python3";
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  tests::ChildProcess receiver(
      {"/usr/bin/python3", "-c",
       "import sys; sys.path.insert(0, sys.argv[1]); import lcm_receiver\n"
       "got = []\n"
       "r = lcm_receiver.open_receiver(sys.argv[2], lambda channel, data: got.append((channel, data)))\n"
       "print('listening', flush=True)\n"
       "while not got: r.handle(0.1)\n"
       "print(got[0][0], len(got[0][1]), got[0][1] == bytes(i % 251 for i in range(100000)))\n",
       tests::source_path("tools/examples"), kUrl});
  ASSERT_TRUE(receiver.wait_for("listening")) << receiver.output();
  const std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm(lcm_create(kUrl), &lcm_destroy);
  std::vector<std::uint8_t> bytes(100000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i % 251);
  lcm_publish(lcm.get(), "BIG", bytes.data(), static_cast<unsigned>(bytes.size()));
  EXPECT_EQ(receiver.wait_for_exit(), 0) << receiver.output();
  EXPECT_THAT(receiver.output(), HasSubstr("BIG 100000 True"));
}

TEST(LcmSubscribers, InspectLcmSaysWhatItHears) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  drivers::LcmPublisher publisher({kUrl, "HOVERMODAL", "", {"tower", 1}});
  tests::ChildProcess inspect({tests::program("hovermodal"), "inspect", "lcm", "--seconds", "3"});
  ASSERT_TRUE(inspect.wait_for("receive buffers")) << inspect.output();
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    publisher.publish(tests::sample_health("running", 1));
  }
  EXPECT_EQ(inspect.wait_for_exit(), 0) << inspect.output();
  EXPECT_THAT(inspect.output(), HasSubstr("a message sent was heard again"));
  EXPECT_THAT(inspect.output(), HasSubstr("from \"tower\""));
}

TEST(LcmSubscribers, SpySaysThatAServiceSpeaksAnotherVersion) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  tests::ChildProcess spy({tests::program("hovermodal"), "spy", "--plain", "--seconds", "4"});
  ASSERT_TRUE(spy.wait_for("listening on")) << spy.output();
  const std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm(lcm_create(kUrl), &lcm_destroy);
  const std::vector<std::uint8_t> bytes(64, 7);
  lcm_publish(lcm.get(), "HOVERMODAL_MODAL_V9", bytes.data(), static_cast<unsigned>(bytes.size()));
  EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
  EXPECT_THAT(spy.output(), HasSubstr("layout 9"));
}

// Withheld messages are counted, are no gap for a listener, and are in the log.
TEST(LcmSubscribers, ACapHoldsBackSamplesNeverModesAndTheLogHasAll) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto folder = own_folder();
  tests::ChildProcess spy(
      {tests::program("hovermodal"), "spy", "--plain", "--once", "--count", (folder / "live.json").string()});
  ASSERT_TRUE(spy.wait_for("listening on")) << spy.output();
  {
    drivers::LcmPublisher publisher({kUrl, "HOVERMODAL", (folder / "run.lcm").string(), {"tower", 1}, 100.0});
    for (int i = 0; i < 5; ++i) publish_run(publisher);
    EXPECT_EQ(publisher.messages_failed(), 0U);
  }
  EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
  tests::ChildProcess log_spy({tests::program("hovermodal"), "spy", "--plain", "--once", "--url",
                               "file://" + (folder / "run.lcm").string() + "?speed=0", "--count",
                               (folder / "log.json").string()});
  EXPECT_EQ(log_spy.wait_for_exit(), 0) << log_spy.output();
  const auto read = [&](const char* name) {
    std::ifstream in(folder / name);
    return nlohmann::json::parse(in, nullptr, false);
  };
  const auto live = read("live.json");
  const auto log = read("log.json");
  EXPECT_TRUE(log["complete"].get<bool>()) << log.dump(2);
  const auto& samples = live["channels"]["HOVERMODAL_DISPLACEMENT"];
  EXPECT_GT(samples["held_back"].get<int>(), 0) << live.dump(2);
  EXPECT_EQ(samples["gaps"], 0);
  EXPECT_EQ(live["channels"]["HOVERMODAL_MODAL"]["held_back"], 0);
  EXPECT_EQ(live["channels"]["HOVERMODAL_SPECTRUM"]["received"], 60) << "they wait for room, or for the end";
  EXPECT_EQ(log["channels"]["HOVERMODAL_DISPLACEMENT"]["received"], 100);
}

}  // namespace
#endif
