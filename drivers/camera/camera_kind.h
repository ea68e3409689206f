#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace drivers {

enum class CameraKind : std::uint8_t { kFile, kSynthetic, kV4l2, kLibcamera };

// As a configuration writes them: camera.driver.
inline constexpr std::array<std::pair<CameraKind, std::string_view>, 4> kCameraKindNames{
    {{CameraKind::kFile, "file"},
     {CameraKind::kSynthetic, "synthetic"},
     {CameraKind::kV4l2, "v4l2"},
     {CameraKind::kLibcamera, "libcamera"}}};

[[nodiscard]] constexpr std::string_view to_string(CameraKind kind) noexcept {
  for (const auto& [one, name] : kCameraKindNames)
    if (one == kind) return name;
  return "";
}

}  // namespace drivers
