#include "rt/event_log.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace rt {
namespace {

TEST(EventLog, HandsOverWhatWasWrittenInOrder) {
  EventLog log;
  log.write("first", 1, 2);
  log.write("second");
  std::vector<std::string> heard;
  EXPECT_EQ(log.drain([&](const Event& event) {
    heard.push_back(event.what + std::to_string(event.values[0]) + std::to_string(event.values[1]));
    EXPECT_GT(event.t_ns, 0);
  }),
            2U);
  EXPECT_EQ(heard, (std::vector<std::string>{"first12", "second00"}));
  EXPECT_EQ(log.drain([](const Event&) {}), 0U);
}

TEST(EventLog, CountsWhatFindsItFull) {
  EventLog log(4);
  for (int i = 0; i < 10; ++i) log.write("again", i);
  EXPECT_EQ(log.n_dropped(), 6U);
  std::int64_t last = -1;
  EXPECT_EQ(log.drain([&](const Event& event) { last = event.values[0]; }), 4U);
  EXPECT_EQ(last, 3) << "the oldest stay";
}

TEST(EventLog, LosesNothingUncountedBetweenTwoThreads) {
  constexpr std::int64_t kEvents = 100'000;
  EventLog log(64);
  std::thread writer([&] {
    for (std::int64_t i = 0; i < kEvents; ++i) log.write("number", i, -i);
  });
  std::uint64_t n_read = 0;
  std::int64_t last = -1;
  const auto take = [&](const Event& event) {
    EXPECT_GT(event.values[0], last);
    EXPECT_EQ(event.values[1], -event.values[0]);
    last = event.values[0];
    ++n_read;
  };
  while (n_read + log.n_dropped() < kEvents) (void)log.drain(take);
  writer.join();
  (void)log.drain(take);
  EXPECT_EQ(n_read + log.n_dropped(), static_cast<std::uint64_t>(kEvents));
}

}  // namespace
}  // namespace rt
