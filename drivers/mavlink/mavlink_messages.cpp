#include "drivers/mavlink/mavlink_messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/types/attitude.h"
#include "core/types/constants.h"
#include "drivers/mavlink/mavlink_layouts.h"

namespace drivers {
namespace {

static_assert(std::endian::native == std::endian::little, "fields of MAVLink are little-endian");

template <class T>
T field(const MavlinkFrame& frame, std::size_t at) noexcept {
  T out{};
  std::memcpy(&out, frame.payload.data() + at, sizeof(T));
  return out;
}
double real(const MavlinkFrame& frame, std::size_t at) noexcept { return static_cast<double>(field<float>(frame, at)); }
template <class T>
void put(MavlinkFrame& frame, std::size_t at, T value) noexcept {
  std::memcpy(frame.payload.data() + at, &value, sizeof(T));
}
void put_text(MavlinkFrame& frame, std::size_t at, std::string_view text, std::size_t most) noexcept {
  std::copy_n(text.begin(), std::min(text.size(), most), frame.payload.begin() + static_cast<std::ptrdiff_t>(at));
}

std::array<double, 4> quaternion_at(const MavlinkFrame& frame, std::size_t at) noexcept {
  std::array<double, 4> out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = real(frame, at + sizeof(float) * i);
  return out;
}

// GIMBAL_DEVICE_FLAGS
constexpr std::uint16_t kYawLock = 16, kYawInVehicleFrame = 32, kYawInEarthFrame = 64;

}  // namespace

std::optional<MavlinkAttitude> mavlink_attitude(const MavlinkFrame& frame) noexcept {
  MavlinkAttitude out;
  std::uint32_t boot_ms = 0;
  if (frame.id == MavlinkFields::Attitude::kId) {
    using At = MavlinkFields::Attitude;
    boot_ms = field<std::uint32_t>(frame, At::time_boot_ms);
    out.wxyz = core::attitude_of(real(frame, At::roll), real(frame, At::pitch), real(frame, At::yaw));
  } else if (frame.id == MavlinkFields::AttitudeQuaternion::kId) {
    using At = MavlinkFields::AttitudeQuaternion;
    boot_ms = field<std::uint32_t>(frame, At::time_boot_ms);
    out.wxyz = quaternion_at(frame, At::q1);
  } else if (frame.id == MavlinkFields::GimbalDeviceAttitudeStatus::kId) {
    using At = MavlinkFields::GimbalDeviceAttitudeStatus;
    boot_ms = field<std::uint32_t>(frame, At::time_boot_ms);
    out.wxyz = quaternion_at(frame, At::q);
    out.of_gimbal = true;
    // Without either flag, a gimbal whose yaw is locked states it from north (the definition of the message).
    const auto flags = field<std::uint16_t>(frame, At::flags);
    const bool from_north =
        (flags & kYawInEarthFrame) != 0 || ((flags & kYawInVehicleFrame) == 0 && (flags & kYawLock) != 0);
    out.yaw_from_aircraft = !from_north;
  } else {
    return std::nullopt;
  }
  out.boot_s = 1e-3 * boot_ms;
  double squares = 0.0;
  for (const double part : out.wxyz) squares += part * part;
  if (!(squares > 0.25) || !(squares < 4.0)) return std::nullopt;
  return out;
}

double yaw_of(const std::array<double, 4>& q) noexcept {
  return std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3]);
}

std::array<double, 4> turned_by_yaw(double yaw_rad, const std::array<double, 4>& q) noexcept {
  const double c = std::cos(0.5 * yaw_rad), s = std::sin(0.5 * yaw_rad);
  return {c * q[0] - s * q[3], c * q[1] - s * q[2], c * q[2] + s * q[1], c * q[3] + s * q[0]};
}

std::optional<MavlinkEscSpeeds> mavlink_esc_speeds(const MavlinkFrame& frame) noexcept {
  MavlinkEscSpeeds out;
  if (frame.id == MavlinkFields::EscStatus::kId) {
    out.first = field<std::uint8_t>(frame, MavlinkFields::EscStatus::index);
    for (std::size_t i = 0; i < out.rpm.size(); ++i)
      out.rpm[i] = field<std::int32_t>(frame, MavlinkFields::EscStatus::rpm + sizeof(std::int32_t) * i);
    return out;
  }
  constexpr std::array kIds{MavlinkFields::EscTelemetry1To4::kId, MavlinkFields::EscTelemetry5To8::kId,
                            MavlinkFields::EscTelemetry9To12::kId};
  static_assert(MavlinkFields::EscTelemetry1To4::rpm == MavlinkFields::EscTelemetry9To12::rpm);
  const auto found = std::find(kIds.begin(), kIds.end(), frame.id);
  if (found == kIds.end()) return std::nullopt;
  out.first = 4 * static_cast<std::size_t>(found - kIds.begin());
  for (std::size_t i = 0; i < out.rpm.size(); ++i)
    out.rpm[i] = field<std::uint16_t>(frame, MavlinkFields::EscTelemetry1To4::rpm + sizeof(std::uint16_t) * i);
  return out;
}

std::optional<MavlinkPosition> mavlink_position(const MavlinkFrame& frame) noexcept {
  using At = MavlinkFields::GlobalPositionInt;
  if (frame.id != At::kId) return std::nullopt;
  return MavlinkPosition{1e-7 * field<std::int32_t>(frame, At::lat), 1e-7 * field<std::int32_t>(frame, At::lon),
                         1e-3 * field<std::int32_t>(frame, At::relative_alt)};
}

std::optional<MavlinkWind> mavlink_wind(const MavlinkFrame& frame) noexcept {
  MavlinkWind out;
  if (frame.id == MavlinkFields::Wind::kId) {
    out = {real(frame, MavlinkFields::Wind::speed), real(frame, MavlinkFields::Wind::direction)};
  } else if (frame.id == MavlinkFields::WindCov::kId) {
    const double north = real(frame, MavlinkFields::WindCov::wind_x),
                 east = real(frame, MavlinkFields::WindCov::wind_y);
    out = {std::hypot(north, east), core::kDegPerRad * std::atan2(-east, -north)};
  } else {
    return std::nullopt;
  }
  if (!std::isfinite(out.speed_m_s) || !std::isfinite(out.from_deg)) return std::nullopt;
  out.from_deg -= 360.0 * std::floor(out.from_deg / 360.0);
  return out;
}

std::optional<MavlinkTimeSync> mavlink_time_sync(const MavlinkFrame& frame) noexcept {
  using At = MavlinkFields::Timesync;
  if (frame.id != At::kId) return std::nullopt;
  return MavlinkTimeSync{field<std::int64_t>(frame, At::tc1), field<std::int64_t>(frame, At::ts1)};
}

MavlinkFrame heartbeat_of_computer() noexcept {
  using At = MavlinkFields::Heartbeat;
  constexpr std::uint8_t kOnboardController = 18, kNoAutopilot = 8, kActive = 4, kVersion = 3;
  MavlinkFrame out{.id = At::kId};
  put(out, At::type, kOnboardController);
  put(out, At::autopilot, kNoAutopilot);
  put(out, At::system_status, kActive);
  put(out, At::mavlink_version, kVersion);
  return out;
}

MavlinkFrame time_sync_question(std::int64_t now_ns) noexcept {
  MavlinkFrame out{.id = MavlinkFields::Timesync::kId};
  put(out, MavlinkFields::Timesync::ts1, now_ns);
  return out;
}

MavlinkFrame named_value(std::string_view name, double value, std::uint32_t boot_ms) noexcept {
  using At = MavlinkFields::NamedValueFloat;
  constexpr std::size_t kName = 10;
  MavlinkFrame out{.id = At::kId};
  put(out, At::time_boot_ms, boot_ms);
  put(out, At::value, static_cast<float>(value));
  put_text(out, At::name, name, kName);
  return out;
}

MavlinkFrame onboard_computer_status(const MavlinkComputer& computer) noexcept {
  using At = MavlinkFields::OnboardComputerStatus;
  MavlinkFrame out{.id = At::kId};
  // Unused fields hold the largest value of their type.
  std::fill(out.payload.begin() + At::ram_usage, out.payload.begin() + At::fan_speed, std::uint8_t{0xFF});
  for (std::size_t i = 0; i < 4; ++i) put(out, At::fan_speed + 2 * i, std::int16_t{0x7FFF});
  std::fill(out.payload.begin() + At::cpu_cores, out.payload.begin() + At::temperature_board, std::uint8_t{0xFF});
  std::fill(out.payload.begin() + At::temperature_board, out.payload.begin() + At::status_flags, std::uint8_t{0x7F});
  put(out, At::time_usec, static_cast<std::uint64_t>(computer.utc_us));
  put(out, At::uptime, static_cast<std::uint32_t>(computer.up_ms));
  put(out, At::type, std::uint8_t{0});
  const auto put_mib = [&](std::size_t at, std::optional<std::int64_t> bytes) {
    if (bytes) put(out, at, static_cast<std::uint32_t>(std::clamp<std::int64_t>(*bytes >> 20, 0, 0xFFFF'FFFE)));
  };
  put_mib(At::ram_usage, computer.memory_used_bytes);
  put_mib(At::ram_total, computer.memory_bytes);
  put_mib(At::storage_usage, computer.disk_used_bytes);
  put_mib(At::storage_total, computer.disk_bytes);
  if (computer.processor_share) {
    const double percent = std::clamp(100.0 * *computer.processor_share, 0.0, 100.0);
    put(out, At::cpu_combined, static_cast<std::uint8_t>(std::lround(percent)));
  }
  if (computer.temperature_c) {
    const double degrees = std::clamp(*computer.temperature_c, -126.0, 126.0);
    put(out, At::temperature_core, static_cast<std::int8_t>(std::lround(degrees)));
  }
  return out;
}

MavlinkFrame status_text(std::string_view text) noexcept {
  using At = MavlinkFields::Statustext;
  constexpr std::uint8_t kInfo = 6;
  constexpr std::size_t kText = 50;
  MavlinkFrame out{.id = At::kId};
  put(out, At::severity, kInfo);
  put_text(out, At::text, text, kText);
  return out;
}

}  // namespace drivers
