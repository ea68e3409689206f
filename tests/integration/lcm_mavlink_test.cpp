#ifdef HOVERMODAL_WITH_LCM
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/types/attitude.h"
#include "drivers/mavlink/mavlink_frame.h"
#include "drivers/mavlink/mavlink_layouts.h"
#include "drivers/mavlink/mavlink_link.h"
#include "drivers/storage/attitude_file.h"
#include "drivers/telemetry/lcm_publisher.h"
#include "drivers/telemetry/sample_listener.h"
#include "rt/clock.h"
#include "tests/support/child_process.h"
#include "tests/support/loopback_network.h"
#include "tests/support/places.h"
#include "tests/support/telemetry_samples.h"

namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr const char* kLink = "127.0.0.1:24831";
constexpr std::int64_t kAhead_ns = 77'000'000'000;

// An autopilot that turns in yaw by 0.1 rad/s, whose clock is ahead; and a ground station that reads named values.
class Autopilot {
 public:
  explicit Autopilot(const std::string& way) : link_(drivers::MavlinkLink::open(way)) {}

  // Sends one attitude, answers what was asked.
  void step() {
    drivers::MavlinkFrame frame{.id = drivers::MavlinkFields::Attitude::kId};
    const std::int64_t remote = rt::monotonic_ns() + kAhead_ns;
    put(frame, drivers::MavlinkFields::Attitude::time_boot_ms, static_cast<std::uint32_t>(remote / 1'000'000));
    put(frame, drivers::MavlinkFields::Attitude::yaw,
        static_cast<float>(0.1 * 1e-9 * static_cast<double>(remote - kAhead_ns)) - static_cast<float>(0.1 * start_s_));
    send(frame);
    send_aircraft();
    std::array<std::uint8_t, 2048> bytes{};
    if (const std::size_t n = link_->receive(bytes, 10); n > 0) {
      parser_.push(std::span(bytes).first(n), [&](const drivers::MavlinkFrame& got) { take(got); });
    }
  }
  [[nodiscard]] double start_s() const { return start_s_; }
  [[nodiscard]] const std::set<std::string>& values() const { return values_; }
  [[nodiscard]] int heartbeats() const { return heartbeats_; }

 private:
  template <class T>
  static void put(drivers::MavlinkFrame& frame, std::size_t at, T value) {
    std::memcpy(frame.payload.data() + at, &value, sizeof(T));
  }
  // Four motors at 95, 96, 97 and 98 turns a second, and where it hovers.
  void send_aircraft() {
    using drivers::MavlinkFields;
    drivers::MavlinkFrame speeds{.id = MavlinkFields::EscStatus::kId};
    for (std::size_t i = 0; i < 4; ++i)
      put(speeds, MavlinkFields::EscStatus::rpm + 4 * i, static_cast<std::int32_t>(60 * (95 + i)));
    send(speeds);
    drivers::MavlinkFrame at{.id = MavlinkFields::GlobalPositionInt::kId};
    put(at, MavlinkFields::GlobalPositionInt::lat, std::int32_t{475'000'000});
    put(at, MavlinkFields::GlobalPositionInt::lon, std::int32_t{82'500'000});
    put(at, MavlinkFields::GlobalPositionInt::relative_alt, std::int32_t{24'500});
    send(at);
  }
  void take(const drivers::MavlinkFrame& got) {
    if (got.id == drivers::MavlinkFields::Heartbeat::kId) ++heartbeats_;
    if (got.id == drivers::MavlinkFields::NamedValueFloat::kId) {
      const auto* name =
          reinterpret_cast<const char*>(got.payload.data() + drivers::MavlinkFields::NamedValueFloat::name);
      values_.insert(std::string(name, strnlen(name, 10)));
    }
    if (got.id != drivers::MavlinkFields::Timesync::kId) return;
    drivers::MavlinkFrame answer = got;
    put(answer, drivers::MavlinkFields::Timesync::tc1, rt::monotonic_ns() + kAhead_ns);
    send(answer);
  }
  void send(drivers::MavlinkFrame frame) {
    frame.system = 1, frame.component = 1, frame.sequence = sequence_++;
    std::array<std::uint8_t, drivers::kMavlinkMostBytes> out{};
    (void)link_->send(std::span(out).first(drivers::write_mavlink(frame, out)));
  }

  std::unique_ptr<drivers::MavlinkLink> link_;
  drivers::MavlinkParser parser_;
  std::uint8_t sequence_ = 0;
  double start_s_ = 1e-9 * static_cast<double>(rt::monotonic_ns());
  std::set<std::string> values_;
  int heartbeats_ = 0;
};

TEST(LcmMavlink, AttitudeReachesTheServicesChannelAndModesTheGroundStation) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto csv = std::filesystem::path(::testing::TempDir()) / "lcm_mavlink.csv";
  const auto listener = drivers::listen_for_attitude(kUrl, "ATTITUDE");
  auto samples = listener->samples();
  drivers::LcmPublisher publisher({kUrl, "HOVERMODAL", "", {"tower", 1}});
  tests::ChildProcess bridge({tests::program("hovermodal"), "mavlink", "--link", std::string("udpin:") + kLink, "--csv",
                              csv.string(), "--seconds", "20"});
  ASSERT_TRUE(bridge.wait_for("waiting for an autopilot")) << bridge.output();
  Autopilot autopilot(std::string("udpout:") + kLink);
  const auto channels = tests::sample_channels(3);
  std::size_t n = 0;
  double worst_s = 0.0;
  for (int i = 0; i < 1000 && (n < 50 || autopilot.values().size() < 4); ++i) {
    if (i % 40 == 30) publisher.publish(tests::sample_estimate(3, 3, static_cast<std::uint64_t>(i)), channels);
    autopilot.step();
    while (const core::AttitudeSample* sample = samples.front()) {
      const auto& q = sample->wxyz;
      const double yaw = 2.0 * std::atan2(q[3], q[0]);
      worst_s = std::max(worst_s, std::abs(yaw / 0.1 + autopilot.start_s() - sample->t_s));
      samples.pop();
      ++n;
    }
  }
  EXPECT_GE(n, 50U) << bridge.output();
  EXPECT_LT(worst_s, 0.01) << "an attitude is where the aircraft was at its time, to a few milliseconds";
  EXPECT_TRUE(autopilot.values().contains("f1_hz"));
  EXPECT_TRUE(autopilot.values().contains("z1_pct"));
  EXPECT_GE(autopilot.heartbeats(), 1);
  bridge.signal(SIGTERM);
  EXPECT_EQ(bridge.wait_for_exit(), 0) << bridge.output();
  EXPECT_NE(bridge.output().find("system 1: "), std::string::npos) << bridge.output();
  EXPECT_GE(drivers::read_attitude_csv(csv.string()).size(), n / 2) << "times that increase only";
}

TEST(LcmMavlink, MotorsAndPlaceReachTheServicesChannelOnceASecond) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto listener = drivers::listen_for_aircraft(kUrl, "AIRCRAFT");
  auto states = listener->samples();
  tests::ChildProcess bridge(
      {tests::program("hovermodal"), "mavlink", "--link", std::string("udpin:") + kLink, "--seconds", "20"});
  ASSERT_TRUE(bridge.wait_for("waiting for an autopilot")) << bridge.output();
  Autopilot autopilot(std::string("udpout:") + kLink);
  const core::AircraftState* state = nullptr;
  for (int i = 0; i < 1000 && state == nullptr; ++i) {
    autopilot.step();
    state = states.front();
  }
  ASSERT_NE(state, nullptr) << bridge.output();
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(state->motor_hz[i], 95.0 + static_cast<double>(i), 1e-9);
  EXPECT_NEAR(state->latitude_deg, 47.5, 1e-6);
  EXPECT_NEAR(state->longitude_deg, 8.25, 1e-6);
  EXPECT_NEAR(state->above_home_m, 24.5, 1e-6);
  EXPECT_TRUE(std::isnan(state->wind_m_s));
  bridge.signal(SIGTERM);
  EXPECT_EQ(bridge.wait_for_exit(), 0) << bridge.output();
}

}  // namespace
#endif
