#ifdef HOVERMODAL_WITH_LCM
#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

#include "drivers/telemetry/lcm_publisher.h"
#include "drivers/telemetry/lcm_self_test.h"
#include "tests/support/loopback_network.h"
#include "tests/support/telemetry_samples.h"

namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";

// Runs `body` in a network without a multicast route; why that cannot be had, or "".
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
    // LCM's socket is made in this thread's network: bring a route up, then take the device down.
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

TEST(LcmNetwork, SelfTestExplainsAWrongUrlInsteadOfThrowing) {
  EXPECT_NE(drivers::lcm_self_test("udpm://nowhere:1").find("multicast address"), std::string::npos);
  EXPECT_EQ(drivers::lcm_self_test("memq://"), "");
}

}  // namespace
#endif
