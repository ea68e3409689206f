#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/types/attitude.h"
#include "drivers/mavlink/mavlink_clock.h"
#include "drivers/mavlink/mavlink_frame.h"
#include "drivers/mavlink/mavlink_messages.h"

namespace drivers {

// A companion computer on a MAVLink network: listens to the autopilot and its gimbal, states that it is there, and
// commands nothing. Pure: bytes and times come in, bytes and attitudes go out. One thread.
class MavlinkCompanion {
 public:
  static constexpr std::size_t kMotors = 12;

  struct Counts {
    std::uint64_t attitudes = 0;
    std::uint64_t before_clock = 0;     // attitudes before the clocks were known
    std::uint64_t without_heading = 0;  // of a gimbal, relative to an aircraft whose heading is not known
    std::uint64_t exchanges = 0;        // of the clocks
    std::uint64_t unasked = 0;          // answers to no question of ours, or with impossible times
    std::uint64_t lost = 0;             // messages of the autopilot, by their numbers
    std::uint64_t not_ours = 0;         // of other senders and of kinds that are not understood
  };
  struct Options {
    bool of_gimbal = false;  // which attitude is handed on: the gimbal's or the aircraft's
    bool datagrams = true;   // how bytes come in
  };
  struct Motor {
    int number = 0;   // from 1
    double hz = 0.0;  // turns per second
  };
  using OnMotor = std::function<void(const Motor&, std::int64_t now_ns)>;
  using OnAttitude = std::function<void(const core::AttitudeSample&)>;  // t_s on this computer's CLOCK_MONOTONIC

  MavlinkCompanion(const Options& options, OnAttitude on_attitude);

  void on_motor(OnMotor call) { on_motor_ = std::move(call); }

  // Bytes as received, at most one datagram. now_ns: CLOCK_MONOTONIC.
  void take(std::span<const std::uint8_t> bytes, std::int64_t now_ns);
  // Bytes to send now: a heartbeat each second, questions of the time ten times a second.
  [[nodiscard]] std::vector<std::uint8_t> due(std::int64_t now_ns);
  [[nodiscard]] std::vector<std::uint8_t> state(const MavlinkComputer& computer);
  // The lowest modes as named values (f1_hz, z1_pct, ...) and one line of text.
  struct Mode {
    double frequency_hz = 0.0, damping_ratio = 0.0;
  };
  [[nodiscard]] std::vector<std::uint8_t> modes(std::span<const Mode> lowest_first, std::int64_t now_ns);

  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }
  [[nodiscard]] const MavlinkParser::Counts& stream() const noexcept { return parser_.counts(); }
  [[nodiscard]] const MavlinkClock& clock() const noexcept { return clock_; }
  [[nodiscard]] std::optional<std::uint8_t> autopilot() const noexcept { return autopilot_; }  // its system id
  [[nodiscard]] const std::optional<MavlinkPosition>& position() const noexcept { return position_; }
  [[nodiscard]] const std::optional<MavlinkWind>& wind() const noexcept { return wind_; }
  // The motors that turn, rotations per second.
  [[nodiscard]] std::vector<double> motors_hz() const;

 private:
  void take(const MavlinkFrame& frame, std::int64_t now_ns);
  [[nodiscard]] bool is_of_autopilot(const MavlinkFrame& frame);
  void take_time(const MavlinkTimeSync& answer, std::int64_t now_ns);
  void take_attitude(MavlinkAttitude attitude);
  void take_speeds(const MavlinkEscSpeeds& speeds, std::int64_t now_ns);
  void append(MavlinkFrame frame, std::vector<std::uint8_t>& out);

  Options options_;
  OnAttitude on_attitude_;
  OnMotor on_motor_;  // may be empty
  MavlinkParser parser_;
  MavlinkClock clock_;
  Counts counts_;
  std::optional<std::uint8_t> autopilot_, last_sequence_;
  std::optional<double> heading_rad_;
  std::optional<MavlinkPosition> position_;
  std::optional<MavlinkWind> wind_;
  std::array<double, kMotors> rpm_{};
  std::array<std::int64_t, 32> asked_ns_{};  // the last questions
  std::size_t n_asked_ = 0;
  std::int64_t next_heartbeat_ns_ = 0, next_question_ns_ = 0;
  std::uint8_t sequence_ = 0;
};

}  // namespace drivers
