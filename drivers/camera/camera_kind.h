#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace drivers {

enum class CameraKind : std::uint8_t { kFile, kSynthetic, kV4l2, kLibcamera, kStream };

// As a configuration writes them: camera.driver.
inline constexpr std::array<std::pair<CameraKind, std::string_view>, 5> kCameraKindNames{
    {{CameraKind::kFile, "file"},
     {CameraKind::kSynthetic, "synthetic"},
     {CameraKind::kV4l2, "v4l2"},
     {CameraKind::kLibcamera, "libcamera"},
     {CameraKind::kStream, "stream"}}};

[[nodiscard]] constexpr std::string_view to_string(CameraKind kind) noexcept {
  for (const auto& [one, name] : kCameraKindNames)
    if (one == kind) return name;
  return "";
}

// camera.transport: an RTSP server sends its pictures inside its own connection, where what is lost is sent again, or
// beside it.
enum class StreamTransport : std::uint8_t { kTcp, kUdp };
inline constexpr std::array<std::pair<StreamTransport, std::string_view>, 2> kStreamTransportNames{
    {{StreamTransport::kTcp, "tcp"}, {StreamTransport::kUdp, "udp"}}};

// Bound on the memory of a video decoder (decoder_memory.h), and what it may be set to.
constexpr int kDecoderMb = 220, kLeastDecoderMb = 20, kMostDecoderMb = 100'000;

}  // namespace drivers
