#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/lcm_url.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace {

std::string refusal(const std::string& url) {
  try {
    drivers::check_lcm_url(url);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

TEST(LcmUrl, ReadsGroupPortAndTtl) {
  const auto url = drivers::parse_udpm("udpm://239.1.2.3:5000?recv_buf_size=100000&ttl=1");
  EXPECT_EQ(url.group, "239.1.2.3");
  EXPECT_EQ(url.port, 5000);
  EXPECT_EQ(url.ttl, 1);
  EXPECT_TRUE(url.has_recv_buf_size);
}

TEST(LcmUrl, TheDefaultStaysOnThisComputer) { EXPECT_EQ(drivers::parse_udpm(drivers::kDefaultLcmUrl).ttl, 0); }

TEST(LcmUrl, RefusesWhatLcmWouldOnlyWarnAbout) {
  for (const char* url :
       {"", "udpm", "udp://239.255.76.67:7667", "udpm://", "udpm://239.255.76.67", "udpm://239.255.76.67:",
        "udpm://239.255.76.67:0", "udpm://239.255.76.67:70000", "udpm://239.255.76.67:7667x", "udpm://10.0.0.1:7667",
        "udpm://host:7667", "udpm://239.255.76.67:7667?ttl=", "udpm://239.255.76.67:7667?ttl=-1",
        "udpm://239.255.76.67:7667?ttl=256", "udpm://239.255.76.67:7667?tll=1", "udpm://239.255.76.67:7667?ttl=0&&",
        "udpm://239.255.76.67:7667?recv_buf_size=0", "udpm://239.255.76.67:7667?recv_buf_size=99999999999"}) {
    const std::string text = refusal(url);
    EXPECT_NE(text.find(fmt::format("\"{}\"", url)), text.npos) << url << " -> " << text;
    EXPECT_NE(text.find("udpm://239.255.76.67:7667?ttl=0"), text.npos) << url;
  }
}

TEST(LcmUrl, LetsOtherProvidersPass) {
  for (const char* url : {"file://run.lcm?mode=w", "memq://", "tcpq://localhost:7700"}) EXPECT_EQ(refusal(url), "");
}

TEST(LcmUrl, RefusesPrefixesThatMakeNoChannelName) {
  EXPECT_NO_THROW(drivers::check_channel_prefix("HOVERMODAL"));
  for (const auto& prefix : {std::string(), std::string("a b"), std::string("a*"), std::string(49, 'a')}) {
    EXPECT_THROW(drivers::check_channel_prefix(prefix), std::invalid_argument) << prefix;
  }
}

}  // namespace
#endif
