#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/log_player.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "drivers/telemetry/event_log.h"
#include "tests/support/test_clip.h"

namespace {

using drivers::LogPlayer;
using drivers::LogUrl;

std::string log_with(std::initializer_list<std::int64_t> utc_ns) {
  const std::string path = (test_support::fresh_folder() / "run.lcm").string();
  drivers::EventLogFile log(path);
  for (const std::int64_t at : utc_ns) EXPECT_TRUE(log.write("C", std::vector<std::uint8_t>{1, 2}, at));
  return path;
}

std::size_t n_heard(const LogUrl& url) {
  std::size_t n = 0;
  LogPlayer player(url, [&](std::string_view, const void*, std::size_t) { ++n; });
  for (int i = 0; i < 100 && player.poll(1); ++i) {
  }
  return n;
}

TEST(LogPlayer, ReadsItsUrl) {
  const LogUrl plain = drivers::parse_log("file://a/run.lcm");
  EXPECT_EQ(plain.path, "a/run.lcm");
  EXPECT_EQ(plain.speed, 1.0);
  const LogUrl fast = drivers::parse_log("file:///run.lcm?speed=0&start_timestamp=12&mode=r");
  EXPECT_EQ(fast.path, "/run.lcm");
  EXPECT_EQ(fast.speed, 0.0);
  EXPECT_EQ(fast.start_utc_us, 12);
  for (const char* url : {"file://", "file://a?speed=", "file://a?speed=-1", "file://a?speed=nan", "file://a?sped=1",
                          "file://a?mode=w", "file://a?start_timestamp=1.5", "udpm://239.255.76.67:7667"})
    EXPECT_THROW(static_cast<void>(drivers::parse_log(url)), std::invalid_argument) << url;
}

TEST(LogPlayer, AsFastAsPossibleBringsAllWhateverTheirTimes) {
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(n_heard({log_with({0, kFar, -kFar, 5}), 0.0, std::numeric_limits<std::int64_t>::min()}), 4U);
}

TEST(LogPlayer, KeepsThePaceAndLeavesOutWhatIsBeforeTheStart) {
  EXPECT_EQ(n_heard({log_with({0, 1000, 3'600'000'000'000}), 1.0, -1}), 2U);  // the third is due in an hour
  EXPECT_EQ(n_heard({log_with({0, 1000, 2000, 3000}), 0.0, 2}), 2U);
}

}  // namespace
#endif
