#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

// Descriptors of a USB camera: USB 2.0 chapter 9, USB Video Class 1.1 chapters 3 and 4. One format, one size,
// one rate, frames over a bulk endpoint.
namespace usb {

enum class VideoFormat { kGray, kYuyv, kMjpeg };  // Y800, YUY2, JPEG

struct VideoMode {
  int width_px = 640;
  int height_px = 480;
  VideoFormat format = VideoFormat::kGray;
  int rate_hz = 30;

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
  // Largest size of a frame; a JPEG is shorter.
  [[nodiscard]] std::size_t frame_bytes() const { return format == VideoFormat::kGray ? pixels() : 2 * pixels(); }
  [[nodiscard]] std::uint32_t interval_100ns() const { return 10'000'000U / static_cast<std::uint32_t>(rate_hz); }
};

constexpr int kCameraTerminal = 1;

class Bytes {
 public:
  void add(std::initializer_list<int> values) {
    for (const int value : values) bytes_.push_back(static_cast<std::uint8_t>(value));
  }
  void add_16(std::size_t value) { add({static_cast<int>(value & 0xFF), static_cast<int>(value >> 8 & 0xFF)}); }
  void add_32(std::size_t value) {
    add_16(value & 0xFFFF);
    add_16(value >> 16);
  }
  void put_16(std::size_t at, std::size_t value) {
    bytes_[at] = static_cast<std::uint8_t>(value & 0xFF);
    bytes_[at + 1] = static_cast<std::uint8_t>(value >> 8 & 0xFF);
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

inline Bytes device_descriptor() {
  Bytes d;
  d.add({18, 1, 0x00, 0x02, 0xEF, 0x02, 0x01, 64, 0x6B, 0x1D, 0x02, 0x01, 0x00, 0x01, 1, 2, 3, 1});
  return d;
}

inline Bytes qualifier_descriptor() {
  Bytes d;
  d.add({10, 6, 0x00, 0x02, 0xEF, 0x02, 0x01, 64, 1, 0});
  return d;
}

inline Bytes string_descriptor(const std::string& text) {
  Bytes d;
  d.add({static_cast<int>(2 + 2 * text.size()), 3});
  for (const char c : text) d.add({c, 0});
  return d;
}

inline Bytes configuration_descriptor(const VideoMode& mode) {
  Bytes d;
  d.add({9, 2, 0, 0, 2, 1, 0, 0x80, 50});
  d.add({8, 0x0B, 0, 2, 0x0E, 3, 0, 0});  // the two interfaces belong together
  d.add({9, 4, 0, 0, 0, 0x0E, 1, 0, 0});  // video control
  const std::size_t control = d.size();
  d.add({13, 0x24, 1, 0x10, 0x01, 0, 0, 0x80, 0x8D, 0x5B, 0x00, 1, 1});
  d.add({17, 0x24, 2, kCameraTerminal, 0x01, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0x0A, 0});  // exposure and its mode
  d.add({9, 0x24, 3, 2, 0x01, 0x01, 0, kCameraTerminal, 0});                              // its output
  d.put_16(control + 5, d.size() - control);
  d.add({9, 4, 1, 0, 1, 0x0E, 2, 0, 0});  // video streaming
  const std::size_t streaming = d.size();
  d.add({14, 0x24, 1, 1, 0, 0, 0x81, 0, 2, 0, 0, 0, 1, 0});
  const bool is_mjpeg = mode.format == VideoFormat::kMjpeg;
  if (is_mjpeg) {
    d.add({11, 0x24, 6, 1, 1, 0, 1, 0, 0, 0, 0});  // format 1 with one frame
  } else {
    d.add({27, 0x24, 4, 1, 1});
    if (mode.format == VideoFormat::kGray) {
      d.add({'Y', '8', '0', '0', 0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71, 8});
    } else {
      d.add({'Y', 'U', 'Y', '2', 0, 0, 0x10, 0, 0x80, 0, 0, 0xAA, 0, 0x38, 0x9B, 0x71, 16});
    }
    d.add({1, 0, 0, 0, 0});
  }
  d.add({30, 0x24, is_mjpeg ? 7 : 5, 1, 0});  // frame 1
  d.add_16(static_cast<std::size_t>(mode.width_px));
  d.add_16(static_cast<std::size_t>(mode.height_px));
  const std::size_t bit_rate = mode.frame_bytes() * 8 * static_cast<std::size_t>(mode.rate_hz);
  d.add_32(bit_rate);
  d.add_32(bit_rate);
  d.add_32(mode.frame_bytes());
  d.add_32(mode.interval_100ns());
  d.add({1});
  d.add_32(mode.interval_100ns());
  d.add({6, 0x24, 0x0D, 1, 1, 4});  // colours
  d.put_16(streaming + 4, d.size() - streaming);
  d.add({7, 5, 0x81, 2, 0, 2, 0});  // bulk, 512 bytes
  d.put_16(2, d.size());
  return d;
}

// The answer to every request about the only streaming mode (video probe and commit control, 34 bytes).
inline Bytes probe_control(const VideoMode& mode) {
  Bytes d;
  d.add({1, 0, 1, 1});
  d.add_32(mode.interval_100ns());
  d.add({0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  d.add_32(mode.frame_bytes());
  d.add_32(mode.frame_bytes() + 2);
  d.add_32(48'000'000);
  d.add({0, 0, 0, 0});
  return d;
}

}  // namespace usb
