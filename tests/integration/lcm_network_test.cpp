#ifdef HOVERMODAL_WITH_LCM
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

#include "drivers/telemetry/lcm_diagnosis.h"
#include "drivers/telemetry/lcm_publisher.h"
#include "drivers/telemetry/lcm_self_test.h"
#include "tests/support/loopback_network.h"
#include "tests/support/telemetry_samples.h"

namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";

// Runs `body` in a network without a multicast route; returns why that is impossible, or "".
template <class Body>
std::string without_route(Body body) {
  std::string why = tests::private_loopback();  // a user namespace, where one is needed
  if (!why.empty()) return why;
  std::thread([&] {
    why = tests::enter_private_network(false);
    if (why.empty()) body();
  }).join();
  return why;
}

void expect_mending(const std::string& text) {
  for (const char* part : {kUrl, "ip route add 224.0.0.0/4 dev lo", "ip link set lo multicast on", "ttl=1", "route"}) {
    EXPECT_NE(text.find(part), text.npos) << part << " in: " << text;
  }
}

TEST(LcmNetwork, SelfTestPassesOverLoopback) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  EXPECT_EQ(drivers::lcm_self_test(kUrl), "");
}

TEST(LcmNetwork, WithoutARouteTheSelfTestSaysHowToMendIt) {
  std::string text;
  const std::string why = without_route([&] { text = drivers::lcm_self_test(kUrl); });
  if (!why.empty()) GTEST_SKIP() << "needs a private network: " << why;
  expect_mending(text);
  EXPECT_NE(text.find("no route"), text.npos) << text;
}

TEST(LcmNetwork, WithoutARouteThePublisherRefusesToStart) {
  std::string text;
  const std::string why = without_route([&] {
    try {
      drivers::LcmPublisher publisher({kUrl, "TEST", "", {}});
    } catch (const std::runtime_error& e) {
      text = e.what();
    }
  });
  if (!why.empty()) GTEST_SKIP() << "needs a private network: " << why;
  expect_mending(text);
}

TEST(LcmNetwork, ARouteLostWhileRunningIsCountedAndLeavesAGapInTheSequence) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const std::string why = without_route([&] {
    // LCM's socket is created in this thread's network: bring a route up, then take the device down.
    ASSERT_EQ(tests::enter_private_network(true), "");
    drivers::LcmPublisher publisher({kUrl, "TEST", "", {}});
    EXPECT_TRUE(publisher.publish(tests::sample_displacement(2, 0), {}));
    ASSERT_EQ(tests::set_loopback(false), "");
    EXPECT_FALSE(publisher.publish(tests::sample_displacement(2, 1), {}));
    EXPECT_EQ(publisher.messages_sent(), 1U);
    EXPECT_EQ(publisher.messages_failed(), 1U);
  });
  if (!why.empty()) GTEST_SKIP() << "needs a private network: " << why;
}

// "BAD <what> | <remedy>; " of every bad finding.
std::string bad_findings(const std::string& url) {
  std::string out;
  for (const auto& finding : drivers::diagnose_lcm(url, "TEST")) {
    if (finding.kind == drivers::FindingKind::kBad) out += finding.what + " | " + finding.remedy + "; ";
  }
  return out;
}

TEST(LcmNetwork, DiagnosisFindsNothingBadOverLoopback) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  EXPECT_EQ(bad_findings(kUrl), "");
}

TEST(LcmNetwork, DiagnosisNamesAMissingRouteAndAnInterfaceThatIsDown) {
  const std::string why = without_route([&] {
    EXPECT_THAT(bad_findings(kUrl), ::testing::HasSubstr("there is no way to 239.255.76.67"));
    EXPECT_THAT(bad_findings(kUrl), ::testing::HasSubstr("ip route add 224.0.0.0/4 dev lo"));
    ASSERT_EQ(tests::set_loopback(false), "");
    EXPECT_THAT(bad_findings(kUrl), ::testing::HasSubstr("lo is down | ip link set lo up"));
  });
  if (!why.empty()) GTEST_SKIP() << "needs a private network: " << why;
}

TEST(LcmNetwork, DiagnosisSeesThatOthersCannotHearOverLoopback) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  EXPECT_THAT(bad_findings("udpm://239.255.76.67:7667?ttl=1"),
              ::testing::HasSubstr("other computers are meant to hear"));
}

TEST(LcmNetwork, DiagnosisOfAFileIsNoTestAndOfAWrongUrlARefusal) {
  EXPECT_EQ(bad_findings("file://run.lcm"), "");
  EXPECT_THROW((void)drivers::diagnose_lcm("udpm://10.0.0.1:7667", "TEST"), std::invalid_argument);
}

TEST(LcmNetwork, SelfTestExplainsAWrongUrlInsteadOfThrowing) {
  EXPECT_NE(drivers::lcm_self_test("udpm://nowhere:1").find("multicast address"), std::string::npos);
  EXPECT_EQ(drivers::lcm_self_test("memq://"), "");
}

}  // namespace
#endif
