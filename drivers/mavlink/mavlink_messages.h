#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "drivers/mavlink/mavlink_frame.h"

namespace drivers {

// Messages of MAVLink that hovermodal reads and sends (https://mavlink.io/en/messages/common.html). The readers accept
// any payload; a value that is not finite gives nothing.

// Of the aircraft (ATTITUDE, ATTITUDE_QUATERNION) or of its gimbal (GIMBAL_DEVICE_ATTITUDE_STATUS).
struct MavlinkAttitude {
  double boot_s = 0.0;                             // on the autopilot's clock, since its start
  std::array<double, 4> wxyz{1.0, 0.0, 0.0, 0.0};  // Hamilton; body axes X ahead, Y right, Z down to north, east, down
  bool of_gimbal = false;
  // The gimbal's yaw is relative to the aircraft's heading, not to north.
  bool yaw_from_aircraft = false;
};
[[nodiscard]] std::optional<MavlinkAttitude> mavlink_attitude(const MavlinkFrame& frame) noexcept;
// Heading of an attitude about the vertical, rad.
[[nodiscard]] double yaw_of(const std::array<double, 4>& wxyz) noexcept;
// The attitude turned about the vertical by this angle.
[[nodiscard]] std::array<double, 4> turned_by_yaw(double yaw_rad, const std::array<double, 4>& wxyz) noexcept;

// Motor speeds (ESC_STATUS; ESC_TELEMETRY_1_TO_4 and the next two of ArduPilot).
struct MavlinkEscSpeeds {
  std::size_t first = 0;  // number of the first motor, from 0
  std::array<double, 4> rpm{};
};
[[nodiscard]] std::optional<MavlinkEscSpeeds> mavlink_esc_speeds(const MavlinkFrame& frame) noexcept;

struct MavlinkPosition {  // GLOBAL_POSITION_INT
  double latitude_deg = 0.0, longitude_deg = 0.0, above_home_m = 0.0;
};
[[nodiscard]] std::optional<MavlinkPosition> mavlink_position(const MavlinkFrame& frame) noexcept;

struct MavlinkWind {  // WIND (ArduPilot) or WIND_COV
  double speed_m_s = 0.0, from_deg = 0.0;
};
[[nodiscard]] std::optional<MavlinkWind> mavlink_wind(const MavlinkFrame& frame) noexcept;

// TIMESYNC: a question has remote_ns = 0; its answer carries the question's time and the answering clock's.
struct MavlinkTimeSync {
  std::int64_t remote_ns = 0, asked_ns = 0;
};
[[nodiscard]] std::optional<MavlinkTimeSync> mavlink_time_sync(const MavlinkFrame& frame) noexcept;

// To be sent; system, component and sequence are the sender's.
[[nodiscard]] MavlinkFrame heartbeat_of_computer() noexcept;  // an active onboard computer, no autopilot
[[nodiscard]] MavlinkFrame time_sync_question(std::int64_t now_ns) noexcept;
// name: at most ten characters.
[[nodiscard]] MavlinkFrame named_value(std::string_view name, double value, std::uint32_t boot_ms) noexcept;
// State of this computer; what is unknown is sent as such.
struct MavlinkComputer {
  std::int64_t utc_us = 0, up_ms = 0;
  std::optional<double> processor_share, temperature_c;  // 0..1 of all processors together
  std::optional<std::int64_t> memory_used_bytes, memory_bytes, disk_used_bytes, disk_bytes;
};
[[nodiscard]] MavlinkFrame onboard_computer_status(const MavlinkComputer& computer) noexcept;
// Severity INFO; at most 50 characters.
[[nodiscard]] MavlinkFrame status_text(std::string_view text) noexcept;

}  // namespace drivers
