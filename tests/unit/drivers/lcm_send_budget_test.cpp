#ifdef HOVERMODAL_WITH_LCM
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "drivers/telemetry/send_budget.h"

namespace {

using drivers::SendBudget;
using drivers::Topic;

constexpr double kRate_kbit_s = 200.0;
constexpr double kBytesPerSecond = kRate_kbit_s * 125.0;

struct Sent {
  double bytes = 0.0;
  int n_sent = 0, n_held = 0;
};

// `seconds` of a service at 25 frames a second: messages admitted, per topic.
std::map<Topic, Sent> run(SendBudget& budget, double seconds, std::size_t displacement_bytes) {
  std::map<Topic, Sent> out;
  const auto offer = [&](Topic topic, std::size_t n_bytes, std::int64_t now_ns) {
    if (budget.admit(topic, n_bytes, now_ns)) {
      out[topic].bytes += static_cast<double>(n_bytes);
      ++out[topic].n_sent;
    } else {
      ++out[topic].n_held;
    }
  };
  for (int frame = 0; frame < static_cast<int>(seconds * 25.0); ++frame) {
    const std::int64_t now_ns = 40'000'000LL * frame;
    offer(drivers::kDisplacement, displacement_bytes, now_ns);
    if (frame % 25 == 0) offer(drivers::kHealth, 2500, now_ns);
    if (frame % 5 == 0) offer(drivers::kTracks, 4500, now_ns);
    if (frame % 250 == 0) {
      for (int i = 0; i < 7; ++i) offer(drivers::kSpectrum, 1200, now_ns);
      for (int i = 0; i < 4; ++i) offer(drivers::kModal, 1300, now_ns);
    }
  }
  return out;
}

double total(const std::map<Topic, Sent>& sent) {
  double bytes = 0.0;
  for (const auto& [topic, one] : sent) bytes += one.bytes;
  return bytes;
}

TEST(SendBudget, WithoutALimitEverythingGoes) {
  SendBudget budget(0.0);
  for (const auto& [topic, sent] : run(budget, 10.0, 5000)) EXPECT_EQ(sent.n_held, 0) << topic;
}

TEST(SendBudget, KeepsTheRateUnderOverloadAndUsesIt) {
  SendBudget budget(kRate_kbit_s);
  const double seconds = 120.0;
  const double bytes = total(run(budget, seconds, 2000));
  EXPECT_LE(bytes, kBytesPerSecond * (seconds + SendBudget::kHolds_s + 1.0));
  EXPECT_GE(bytes, 0.9 * kBytesPerSecond * seconds);
}

TEST(SendBudget, ModesAndHealthAlwaysGoAndNobodyElseIsSilenced) {
  SendBudget budget(kRate_kbit_s);
  auto sent = run(budget, 120.0, 2000);
  EXPECT_EQ(sent[drivers::kHealth].n_held, 0);
  EXPECT_EQ(sent[drivers::kModal].n_held, 0);
  for (const Topic topic : {drivers::kDisplacement, drivers::kSpectrum, drivers::kTracks}) {
    EXPECT_GT(sent[topic].n_held, 0) << topic;
    EXPECT_GT(sent[topic].n_sent, 20) << topic;
  }
}

TEST(SendBudget, WhatFitsIsNotThinned) {
  SendBudget budget(1000.0);
  for (const auto& [topic, sent] : run(budget, 60.0, 250)) EXPECT_EQ(sent.n_held, 0) << topic;
}

TEST(SendBudget, AMessageLargerThanItsBucketGoesWhenTheBucketIsFull) {
  SendBudget budget(16.0);  // its tracks bucket holds 200 bytes
  EXPECT_TRUE(budget.admit(drivers::kTracks, 5000, 0));
  EXPECT_FALSE(budget.admit(drivers::kTracks, 5000, 1'000'000'000));
  EXPECT_TRUE(budget.admit(drivers::kTracks, 5000, 20'000'000'000));
}

TEST(SendBudget, MessagesThatAlwaysGoAreOwedAndPaidFirst) {
  SendBudget budget(kRate_kbit_s);
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(budget.admit(drivers::kModal, 1300, 0));  // two seconds of the link
  while (budget.admit(drivers::kDisplacement, 300, 0)) {
  }
  EXPECT_FALSE(budget.admit(drivers::kDisplacement, 300, 1'500'000'000));
  EXPECT_TRUE(budget.admit(drivers::kDisplacement, 300, 2'500'000'000));
}

TEST(SendBudget, AClockThatGoesBackFillsNothing) {
  SendBudget budget(kRate_kbit_s);
  while (budget.admit(drivers::kDisplacement, 300, 1'000'000'000)) {
  }
  EXPECT_FALSE(budget.admit(drivers::kDisplacement, 300, 0));
  EXPECT_FALSE(budget.admit(drivers::kDisplacement, 300, 0));
}

TEST(SendBudget, NeverAboveTheRateWhateverIsOffered) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    SendBudget budget(kRate_kbit_s);
    constexpr std::array<Topic, 3> kThinned{drivers::kDisplacement, drivers::kSpectrum, drivers::kTracks};
    std::int64_t now_ns = 0;
    double bytes = 0.0;
    for (int i = 0; i < 20000; ++i) {
      now_ns += static_cast<std::int64_t>(random() % 20'000'000);
      const std::size_t n = 100 + random() % 3000;
      if (budget.admit(kThinned[random() % 3], n, now_ns)) bytes += static_cast<double>(n);
    }
    EXPECT_LE(bytes, kBytesPerSecond * (static_cast<double>(now_ns) * 1e-9 + SendBudget::kHolds_s) + 3.0 * 3100.0);
  }
}

TEST(WireBytes, CountTheHeadsOfEveryFragment) {
  EXPECT_EQ(drivers::wire_bytes(10, 100), 100U + 11U + 48U);
  EXPECT_EQ(drivers::wire_bytes(10, 1401), 1401U + 11U + 2U * 48U);
}

}  // namespace
#endif
