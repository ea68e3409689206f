#include "drivers/mavlink/mavlink_companion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <vector>

#include "drivers/mavlink/mavlink_clock.h"
#include "drivers/mavlink/mavlink_layouts.h"
#include "drivers/mavlink/mavlink_link.h"

namespace drivers {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::int64_t kMs = 1'000'000, kSecond = 1'000'000'000;

template <class T>
void put(MavlinkFrame& frame, std::size_t at, T value) {
  std::memcpy(frame.payload.data() + at, &value, sizeof(T));
}

// Frames of an autopilot with system 7.
class Autopilot {
 public:
  std::uint8_t system = 7, component = 1;
  [[nodiscard]] Bytes bytes(MavlinkFrame frame) {
    frame.system = system, frame.component = component, frame.sequence = sequence++;
    std::array<std::uint8_t, kMavlinkMostBytes> out{};
    const std::size_t n = write_mavlink(frame, out);
    return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(n)};
  }
  [[nodiscard]] Bytes attitude(double boot_s, double roll, double pitch, double yaw) {
    using At = MavlinkFields::Attitude;
    MavlinkFrame frame{.id = At::kId};
    put(frame, At::time_boot_ms, static_cast<std::uint32_t>(1e3 * boot_s));
    put(frame, At::roll, static_cast<float>(roll));
    put(frame, At::pitch, static_cast<float>(pitch));
    put(frame, At::yaw, static_cast<float>(yaw));
    return bytes(frame);
  }
  [[nodiscard]] Bytes gimbal(double boot_s, const std::array<double, 4>& q, std::uint16_t flags) {
    using At = MavlinkFields::GimbalDeviceAttitudeStatus;
    MavlinkFrame frame{.id = At::kId};
    put(frame, At::time_boot_ms, static_cast<std::uint32_t>(1e3 * boot_s));
    for (std::size_t i = 0; i < 4; ++i) put(frame, At::q + 4 * i, static_cast<float>(q[i]));
    put(frame, At::flags, flags);
    return bytes(frame);
  }
  std::uint8_t sequence = 0;
};

// The autopilot's clock is ahead by 5 s and is answered without delay.
void set_clock(MavlinkCompanion& companion, Autopilot& autopilot, std::int64_t from_ns) {
  for (std::int64_t i = 0; i < 12; ++i) {
    const std::int64_t now = from_ns + i * 100 * kMs;
    MavlinkParser parser;
    parser.push(companion.due(now), [&](const MavlinkFrame& question) {
      if (question.id != MavlinkFields::Timesync::kId) return;
      MavlinkFrame answer = question;
      put(answer, MavlinkFields::Timesync::tc1, now + 5 * kSecond);
      companion.take(autopilot.bytes(answer), now);
    });
  }
}

TEST(MavlinkCompanion, AttitudesAreOnThisComputersClock) {
  std::vector<core::AttitudeSample> got;
  MavlinkCompanion companion({}, [&](const core::AttitudeSample& s) { got.push_back(s); });
  Autopilot autopilot;
  companion.take(autopilot.attitude(105.0, 0.1, 0.2, 0.3), 100 * kSecond);
  EXPECT_TRUE(got.empty());
  EXPECT_EQ(companion.counts().before_clock, 1U);
  set_clock(companion, autopilot, 100 * kSecond);
  companion.take(autopilot.attitude(110.0, 0.1, 0.2, 0.3), 106 * kSecond);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_NEAR(got[0].t_s, 105.0, 1e-3);
  const auto q = core::attitude_of(0.1, 0.2, 0.3);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(got[0].wxyz[i], q[i], 1e-6);
  EXPECT_EQ(companion.counts().lost, 0U);
}

TEST(MavlinkCompanion, LostMessagesOfTheAutopilotAreCountedAndOthersAreNotRead) {
  std::vector<core::AttitudeSample> got;
  MavlinkCompanion companion({}, [&](const core::AttitudeSample& s) { got.push_back(s); });
  Autopilot autopilot, other;
  set_clock(companion, autopilot, kSecond);
  autopilot.sequence = static_cast<std::uint8_t>(autopilot.sequence + 3);
  companion.take(autopilot.attitude(8.0, 0.0, 0.0, 0.0), 3 * kSecond);
  EXPECT_EQ(companion.counts().lost, 3U);
  other.system = 8;
  companion.take(other.attitude(8.0, 0.0, 0.0, 0.0), 3 * kSecond);
  EXPECT_EQ(got.size(), 1U);
  EXPECT_EQ(companion.counts().not_ours, 1U);
}

TEST(MavlinkCompanion, AGimbalsYawIsFromNorthOrAddedToTheAircraftsHeading) {
  std::vector<core::AttitudeSample> got;
  MavlinkCompanion companion({.of_gimbal = true}, [&](const core::AttitudeSample& s) { got.push_back(s); });
  Autopilot autopilot, gimbal;
  gimbal.component = 154;
  set_clock(companion, autopilot, kSecond);
  const auto down = core::attitude_of(0.0, -0.5, 0.2);
  companion.take(gimbal.gimbal(8.0, down, 32), 3 * kSecond);
  EXPECT_EQ(companion.counts().without_heading, 1U);
  companion.take(autopilot.attitude(8.0, 0.05, 0.0, 1.0), 3 * kSecond);
  companion.take(gimbal.gimbal(8.0, down, 32), 3 * kSecond);
  companion.take(gimbal.gimbal(8.1, down, 64), 3 * kSecond);
  companion.take(gimbal.gimbal(8.2, down, 16), 3 * kSecond);
  ASSERT_EQ(got.size(), 3U);
  EXPECT_NEAR(yaw_of(got[0].wxyz), 1.2, 1e-4);
  EXPECT_NEAR(yaw_of(got[1].wxyz), 0.2, 1e-6);
  EXPECT_NEAR(yaw_of(got[2].wxyz), 0.2, 1e-6) << "locked: from north";
}

TEST(MavlinkCompanion, AnswersThatNobodyAskedForDoNotMoveTheClock) {
  MavlinkCompanion companion({}, [](const core::AttitudeSample&) {});
  Autopilot autopilot;
  set_clock(companion, autopilot, kSecond);
  const auto before = companion.clock().fit();
  ASSERT_TRUE(before);
  for (const std::int64_t remote :
       {std::int64_t{1}, std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()}) {
    for (const std::int64_t asked : {std::int64_t{0}, 12345 * kMs, std::numeric_limits<std::int64_t>::min()}) {
      MavlinkFrame answer{.id = MavlinkFields::Timesync::kId};
      put(answer, MavlinkFields::Timesync::tc1, remote);
      put(answer, MavlinkFields::Timesync::ts1, asked);
      companion.take(autopilot.bytes(answer), 4 * kSecond);
    }
  }
  EXPECT_EQ(companion.counts().unasked, 9U);
  EXPECT_EQ(companion.clock().fit()->offset_ns, before->offset_ns);
}

TEST(MavlinkCompanion, ModesAreNamedValuesAndALineOfText) {
  MavlinkCompanion companion({}, [](const core::AttitudeSample&) {});
  const std::vector<MavlinkCompanion::Mode> modes{{1.664, 0.012}, {4.9, 0.008}};
  std::vector<MavlinkFrame> sent;
  MavlinkParser parser;
  parser.push(companion.modes(modes, 9 * kSecond), [&](const MavlinkFrame& frame) { sent.push_back(frame); });
  ASSERT_EQ(sent.size(), 5U);
  float value = 0.0F;
  std::memcpy(&value, sent[0].payload.data() + MavlinkFields::NamedValueFloat::value, sizeof(value));
  EXPECT_FLOAT_EQ(value, 1.664F);
  EXPECT_STREQ(reinterpret_cast<const char*>(sent[1].payload.data() + MavlinkFields::NamedValueFloat::name), "z1_pct");
  EXPECT_STREQ(reinterpret_cast<const char*>(sent[4].payload.data() + MavlinkFields::Statustext::text),
               "modes Hz: 1.66 4.9");
  EXPECT_EQ(sent[0].component, 191);
}

TEST(MavlinkCompanion, TheComputersStateIsSentAndWhatIsUnknownMarked) {
  using At = MavlinkFields::OnboardComputerStatus;
  MavlinkCompanion companion({}, [](const core::AttitudeSample&) {});
  MavlinkComputer computer;
  computer.utc_us = 1'700'000'000'000'000, computer.up_ms = 61'000, computer.processor_share = 0.426;
  computer.memory_used_bytes = std::int64_t{700} << 20, computer.memory_bytes = std::int64_t{4} << 30;
  std::vector<MavlinkFrame> sent;
  MavlinkParser parser;
  parser.push(companion.state(computer), [&](const MavlinkFrame& frame) { sent.push_back(frame); });
  ASSERT_EQ(sent.size(), 1U);
  const auto field = [&]<class T>(std::size_t at, T out) {
    std::memcpy(&out, sent[0].payload.data() + at, sizeof(T));
    return out;
  };
  EXPECT_EQ(sent[0].id, At::kId);
  EXPECT_EQ(field(At::time_usec, std::uint64_t{}), 1'700'000'000'000'000U);
  EXPECT_EQ(field(At::uptime, std::uint32_t{}), 61'000U);
  EXPECT_EQ(field(At::ram_usage, std::uint32_t{}), 700U);
  EXPECT_EQ(field(At::ram_total, std::uint32_t{}), 4096U);
  EXPECT_EQ(field(At::cpu_combined, std::uint8_t{}), 43U);
  EXPECT_EQ(field(At::cpu_combined + 1, std::uint8_t{}), 0xFFU);
  EXPECT_EQ(field(At::storage_total, std::uint32_t{}), 0xFFFF'FFFFU);
  EXPECT_EQ(field(At::link_rx_max + 20, std::uint32_t{}), 0xFFFF'FFFFU);
  EXPECT_EQ(field(At::fan_speed + 6, std::int16_t{}), 0x7FFF);
  EXPECT_EQ(field(At::temperature_board, std::int8_t{}), 0x7F);
  EXPECT_EQ(field(At::temperature_core, std::int8_t{}), 0x7F);
  EXPECT_EQ(field(At::status_flags, std::uint16_t{}), 0U);
}

TEST(MavlinkCompanion, MotorsAreStatedInTurnsPerSecond) {
  MavlinkCompanion companion({}, [](const core::AttitudeSample&) {});
  Autopilot autopilot;
  MavlinkFrame frame{.id = MavlinkFields::EscTelemetry5To8::kId};
  put(frame, MavlinkFields::EscTelemetry5To8::rpm + 2, std::uint16_t{5400});
  std::vector<MavlinkCompanion::Motor> heard;
  companion.on_motor([&](const MavlinkCompanion::Motor& motor, std::int64_t now_ns) {
    EXPECT_EQ(now_ns, kSecond);
    heard.push_back(motor);
  });
  companion.take(autopilot.bytes(frame), kSecond);
  ASSERT_EQ(companion.motors_hz().size(), 1U);
  EXPECT_DOUBLE_EQ(companion.motors_hz()[0], 90.0);
  ASSERT_EQ(heard.size(), 1U) << "of four motors three stand";
  EXPECT_EQ(heard[0].number, 6);
  EXPECT_DOUBLE_EQ(heard[0].hz, 90.0);
}

// 50 ms each way with 20 ms of jitter; the clocks drift by 40 ppm.
TEST(MavlinkClock, DelayAndJitterAreSeenThrough) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> jitter(0.0, 20e6);
  MavlinkClock clock;
  EXPECT_FALSE(clock.local_ns(1.0));
  const auto remote = [](double local_ns) { return 1.7e9 + local_ns * (1.0 + 40e-6); };
  double now = 1e12;
  for (int i = 0; i < 600; ++i, now += 1e8) {
    const double there = now + 50e6 + jitter(engine), back = there + 50e6 + jitter(engine);
    ASSERT_TRUE(clock.add(std::llround(now), std::llround(remote(there)), std::llround(back)));
  }
  const auto fit = clock.fit();
  ASSERT_TRUE(fit);
  const double error =
      fit->offset_ns - (remote(static_cast<double>(fit->local_ns)) - static_cast<double>(fit->local_ns));
  EXPECT_LT(std::abs(error), 2e6);
  EXPECT_LT(std::abs(error), 4.0 * fit->sigma_ns);
  EXPECT_LT(fit->sigma_ns, 2e6);
  EXPECT_NEAR(static_cast<double>(*clock.local_ns(1e-9 * remote(now))), now, 2e6);
}

TEST(MavlinkClock, ARestartedAutopilotBeginsAnew) {
  MavlinkClock clock;
  for (std::int64_t i = 0; i < 20; ++i)
    (void)clock.add(i * 100 * kMs, 500 * kSecond + i * 100 * kMs, i * 100 * kMs + 4 * kMs);
  (void)clock.add(3 * kSecond, kSecond, 3 * kSecond + 4 * kMs);
  EXPECT_EQ(clock.restarts(), 1U);
  EXPECT_FALSE(clock.fit());
  EXPECT_FALSE(clock.add(5 * kSecond, kSecond, 4 * kSecond)) << "received before it was sent";
  EXPECT_FALSE(clock.add(5 * kSecond, kSecond, 9 * kSecond)) << "four seconds on the way";
}

TEST(MavlinkLink, WaysAreChecked) {
  for (const char* way : {"", "udp", "udpin:14550", "udpin::14550", "udpin:127.0.0.1:", "udpin:127.0.0.1:70000",
                          "udpin:127.0.0.1:12x", "serial:/dev/null:1234", "http:localhost:80"}) {
    EXPECT_THROW((void)MavlinkLink::open(way), std::invalid_argument) << way;
  }
  EXPECT_THROW((void)MavlinkLink::open("serial:/dev/null:57600"), std::runtime_error) << "no serial line";
  EXPECT_THROW((void)MavlinkLink::open("serial:/nowhere:57600"), std::runtime_error);
}

TEST(MavlinkLink, TheFirstSenderOfDatagramsIsAnsweredAndOthersAreNotRead) {
  const auto ground = MavlinkLink::open("udpin:127.0.0.1:24817");
  const auto first = MavlinkLink::open("udpout:127.0.0.1:24817"), second = MavlinkLink::open("udpout:127.0.0.1:24817");
  std::array<std::uint8_t, 64> bytes{};
  EXPECT_FALSE(ground->send(Bytes{1})) << "nobody yet";
  EXPECT_TRUE(first->send(Bytes{1, 2, 3}));
  EXPECT_EQ(ground->receive(bytes, 1000), 3U);
  EXPECT_TRUE(second->send(Bytes{4}));
  EXPECT_EQ(ground->receive(bytes, 1000), 0U);
  EXPECT_EQ(ground->from_others(), 1U);
  EXPECT_TRUE(ground->send(Bytes{5, 6}));
  EXPECT_EQ(first->receive(bytes, 1000), 2U);
  EXPECT_EQ(bytes[1], 6);
  EXPECT_TRUE(first->is_datagrams());
}

}  // namespace
}  // namespace drivers
