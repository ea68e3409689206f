#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/sample_inbox.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using drivers::AircraftInbox;
using drivers::AttitudeInbox;
using Bytes = std::vector<std::uint8_t>;

Bytes encoded(std::int64_t time_ns, double w, double x, double y, double z) {
  const hovermodal::attitude_t message{time_ns, {w, x, y, z}};
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

TEST(AttitudeInbox, HandsOverWhatWasSentInOrder) {
  AttitudeInbox inbox;
  auto samples = inbox.samples();
  for (int k = 1; k <= 3; ++k) {
    const Bytes bytes = encoded(k * 1'000'000'000LL, 1.0, 0.1 * k, 0.0, 0.0);
    inbox.receive(bytes.data(), bytes.size());
  }
  for (int k = 1; k <= 3; ++k) {
    const core::AttitudeSample* sample = samples.front();
    ASSERT_NE(sample, nullptr);
    EXPECT_DOUBLE_EQ(sample->t_s, k);
    EXPECT_DOUBLE_EQ(sample->wxyz[1], 0.1 * k);
    samples.pop();
  }
  EXPECT_EQ(inbox.counts().received, 3U);
}

TEST(AttitudeInbox, CountsWhatIsNoAttitude) {
  AttitudeInbox inbox;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Bytes& bytes : {encoded(1, nan, 0.0, 0.0, 0.0), encoded(1, 0.0, 0.0, 0.0, 0.0),
                             encoded(1, std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0), Bytes{}, Bytes(7)}) {
    inbox.receive(bytes.data(), bytes.size());
  }
  const Bytes whole = encoded(1, 1.0, 0.0, 0.0, 0.0);
  for (std::size_t n = 0; n < whole.size(); ++n) inbox.receive(whole.data(), n);
  Bytes longer = whole;
  longer.push_back(0);
  inbox.receive(longer.data(), longer.size());
  EXPECT_EQ(inbox.counts().undecodable, 5U + whole.size() + 1U);
  EXPECT_EQ(inbox.counts().received, 0U);
  EXPECT_EQ(inbox.samples().front(), nullptr);
}

TEST(AttitudeInbox, AFloodIsDroppedAndCounted) {
  AttitudeInbox inbox;
  const Bytes bytes = encoded(1, 1.0, 0.0, 0.0, 0.0);
  for (std::size_t k = 0; k < AttitudeInbox::kSlots + 10; ++k) inbox.receive(bytes.data(), bytes.size());
  EXPECT_EQ(inbox.counts().received, AttitudeInbox::kSlots);
  EXPECT_EQ(inbox.counts().dropped, 10U);
}

TEST(AttitudeInbox, RandomBytesNeverCrash) {
  AttitudeInbox inbox;
  std::mt19937 random(1);
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes = encoded(round, 1.0, 0.0, 0.0, 0.0);
    for (int k = 0; k < 4; ++k) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes.resize(random() % (bytes.size() + 4));
    inbox.receive(bytes.data(), bytes.size());
  }
  const auto counts = inbox.counts();
  EXPECT_EQ(counts.received + counts.undecodable + counts.dropped, 20000U);
}

// --- the aircraft --------------------------------------------------------------------------------------------------

core::AircraftState hovering() {
  core::AircraftState state;
  state.t_s = 12.5;
  state.motor_hz[0] = 95.25, state.motor_hz[3] = 96.5;
  state.latitude_deg = -33.25, state.longitude_deg = 151.5, state.above_home_m = 24.5;
  state.wind_m_s = 4.25, state.wind_from_deg = 310.0;
  return state;
}

Bytes encoded(const hovermodal::aircraft_t& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

void give(AircraftInbox& inbox, const hovermodal::aircraft_t& message) {
  const Bytes bytes = encoded(message);
  inbox.receive(bytes.data(), bytes.size());
}

TEST(AircraftInbox, HandsOverWhatWasSent) {
  AircraftInbox inbox;
  auto states = inbox.samples();
  give(inbox, drivers::to_message(hovering()));
  const core::AircraftState* state = states.front();
  ASSERT_NE(state, nullptr);
  const core::AircraftState sent = hovering();
  EXPECT_EQ(state->t_s, sent.t_s);
  EXPECT_EQ(state->motor_hz, sent.motor_hz);
  EXPECT_EQ(state->latitude_deg, sent.latitude_deg);
  EXPECT_EQ(state->longitude_deg, sent.longitude_deg);
  EXPECT_EQ(state->above_home_m, sent.above_home_m);
  EXPECT_EQ(state->wind_m_s, sent.wind_m_s);
  EXPECT_EQ(state->wind_from_deg, sent.wind_from_deg);
}

TEST(AircraftInbox, ValuesThatCannotBeAreUnknown) {
  AircraftInbox inbox;
  auto states = inbox.samples();
  hovermodal::aircraft_t message = drivers::to_message(hovering());
  message.latitude_deg = 1e300, message.wind_m_s = -1.0, message.above_home_m = std::numeric_limits<double>::infinity();
  message.motor_hz[0] = std::numeric_limits<double>::quiet_NaN(), message.motor_hz[3] = 1e12;
  give(inbox, message);
  const core::AircraftState* state = states.front();
  ASSERT_NE(state, nullptr);
  EXPECT_TRUE(std::isnan(state->latitude_deg));
  EXPECT_TRUE(std::isnan(state->wind_m_s));
  EXPECT_TRUE(std::isnan(state->above_home_m));
  for (const double hz : state->motor_hz) EXPECT_EQ(hz, 0.0);
  EXPECT_EQ(state->longitude_deg, 151.5);
}

TEST(AircraftInbox, TooManyMotorsAndOtherBytesAreCounted) {
  AircraftInbox inbox;
  hovermodal::aircraft_t message = drivers::to_message(hovering());
  message.motor_hz.assign(17, 90.0), message.n_motors = 17;
  give(inbox, message);
  std::mt19937 random(1);
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes = encoded(drivers::to_message(hovering()));
    for (int k = 0; k < 4; ++k) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes.resize(random() % (bytes.size() + 4));
    inbox.receive(bytes.data(), bytes.size());
  }
  const auto counts = inbox.counts();
  EXPECT_GE(counts.undecodable, 1U);
  EXPECT_EQ(counts.received + counts.undecodable + counts.dropped, 20001U);
}

}  // namespace
#endif
