#include "drivers/mavlink/mavlink_companion.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "drivers/mavlink/mavlink_layouts.h"

namespace drivers {
namespace {

constexpr std::int64_t kHeartbeat_ns = 1'000'000'000, kQuestion_ns = 100'000'000;
constexpr std::uint8_t kAutopilotComponent = 1, kOnboardComputerComponent = 191;
constexpr std::size_t kMostModes = 6;

constexpr double kTurns_rpm = 60.0;  // slower: it stands

}  // namespace

MavlinkCompanion::MavlinkCompanion(const Options& options, OnAttitude on_attitude)
    : options_(options), on_attitude_(std::move(on_attitude)) {}

void MavlinkCompanion::take(std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
  parser_.push(bytes, [&](const MavlinkFrame& frame) { take(frame, now_ns); });
  if (options_.datagrams) parser_.end_datagram();
}

// The first autopilot that states itself, by its heartbeat or by its own kinds of messages.
bool MavlinkCompanion::is_of_autopilot(const MavlinkFrame& frame) {
  if (frame.component != kAutopilotComponent) return false;
  if (!autopilot_) autopilot_ = frame.system;
  if (frame.system != *autopilot_) return false;
  if (last_sequence_) counts_.lost += static_cast<std::uint8_t>(frame.sequence - *last_sequence_ - 1U);
  last_sequence_ = frame.sequence;
  return true;
}

void MavlinkCompanion::take(const MavlinkFrame& frame, std::int64_t now_ns) {
  const bool of_autopilot = is_of_autopilot(frame);
  const std::optional<MavlinkAttitude> attitude = mavlink_attitude(frame);
  // A gimbal is a component of its own in the autopilot's system, or the autopilot speaks for it.
  if (attitude && attitude->of_gimbal && (of_autopilot || frame.system == autopilot_)) return take_attitude(*attitude);
  if (!of_autopilot) {
    ++counts_.not_ours;
    return;
  }
  if (attitude) return take_attitude(*attitude);
  if (const auto answer = mavlink_time_sync(frame)) return take_time(*answer, now_ns);
  if (const auto position = mavlink_position(frame)) {
    position_ = position;
  } else if (const auto wind = mavlink_wind(frame)) {
    wind_ = wind;
  } else if (const auto speeds = mavlink_esc_speeds(frame)) {
    take_speeds(*speeds, now_ns);
  } else if (frame.id != MavlinkFields::Heartbeat::kId) {
    ++counts_.not_ours;
  }
}

// A message states four motors, whether they are there or not.
void MavlinkCompanion::take_speeds(const MavlinkEscSpeeds& speeds, std::int64_t now_ns) {
  for (std::size_t i = 0; i < speeds.rpm.size() && speeds.first + i < kMotors; ++i) {
    const std::size_t motor = speeds.first + i;
    rpm_[motor] = speeds.rpm[i];
    if (on_motor_ && rpm_[motor] >= kTurns_rpm) on_motor_({static_cast<int>(motor) + 1, rpm_[motor] / 60.0}, now_ns);
  }
}

void MavlinkCompanion::take_time(const MavlinkTimeSync& answer, std::int64_t now_ns) {
  if (answer.remote_ns == 0) return;  // the autopilot's own question: it needs no answer of ours
  const auto asked = std::find(asked_ns_.begin(), asked_ns_.end(), answer.asked_ns);
  if (asked == asked_ns_.end() || *asked == 0 || !clock_.add(answer.asked_ns, answer.remote_ns, now_ns)) {
    ++counts_.unasked;
    return;
  }
  *asked = 0;  // answered once
  ++counts_.exchanges;
}

void MavlinkCompanion::take_attitude(MavlinkAttitude attitude) {
  if (!attitude.of_gimbal) heading_rad_ = yaw_of(attitude.wxyz);
  if (attitude.of_gimbal != options_.of_gimbal) return;
  if (attitude.yaw_from_aircraft) {
    if (!heading_rad_) {
      ++counts_.without_heading;
      return;
    }
    attitude.wxyz = turned_by_yaw(*heading_rad_, attitude.wxyz);
  }
  const std::optional<std::int64_t> local_ns = clock_.local_ns(attitude.boot_s);
  if (!local_ns) {
    ++counts_.before_clock;
    return;
  }
  ++counts_.attitudes;
  on_attitude_({.t_s = 1e-9 * static_cast<double>(*local_ns), .wxyz = attitude.wxyz});
}

void MavlinkCompanion::append(MavlinkFrame frame, std::vector<std::uint8_t>& out) {
  frame.system = autopilot_.value_or(1), frame.component = kOnboardComputerComponent, frame.sequence = sequence_++;
  std::array<std::uint8_t, kMavlinkMostBytes> bytes{};
  const std::size_t n = write_mavlink(frame, bytes);
  out.insert(out.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
}

std::vector<std::uint8_t> MavlinkCompanion::due(std::int64_t now_ns) {
  std::vector<std::uint8_t> out;
  if (now_ns >= next_heartbeat_ns_) {
    append(heartbeat_of_computer(), out);
    next_heartbeat_ns_ = now_ns + kHeartbeat_ns;
  }
  if (now_ns >= next_question_ns_) {
    append(time_sync_question(now_ns), out);
    asked_ns_[n_asked_++ % asked_ns_.size()] = now_ns;
    next_question_ns_ = now_ns + kQuestion_ns;
  }
  return out;
}

std::vector<std::uint8_t> MavlinkCompanion::state(const MavlinkComputer& computer) {
  std::vector<std::uint8_t> out;
  append(onboard_computer_status(computer), out);
  return out;
}

std::vector<std::uint8_t> MavlinkCompanion::modes(std::span<const Mode> lowest_first, std::int64_t now_ns) {
  std::vector<std::uint8_t> out;
  const auto boot_ms = static_cast<std::uint32_t>(now_ns / 1'000'000);
  std::string text = "modes Hz:";
  for (std::size_t i = 0; i < std::min(lowest_first.size(), kMostModes); ++i) {
    const Mode& mode = lowest_first[i];
    append(named_value("f" + std::to_string(i + 1) + "_hz", mode.frequency_hz, boot_ms), out);
    append(named_value("z" + std::to_string(i + 1) + "_pct", 100.0 * mode.damping_ratio, boot_ms), out);
    std::array<char, 16> number{};
    (void)std::snprintf(number.data(), number.size(), " %.3g", mode.frequency_hz);
    text += number.data();
  }
  append(status_text(lowest_first.empty() ? "hovermodal: no modes yet" : text), out);
  return out;
}

std::vector<double> MavlinkCompanion::motors_hz() const {
  std::vector<double> out;
  for (const double rpm : rpm_) {
    if (rpm >= kTurns_rpm) out.push_back(rpm / 60.0);
  }
  return out;
}

}  // namespace drivers
