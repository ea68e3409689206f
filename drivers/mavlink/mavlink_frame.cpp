#include "drivers/mavlink/mavlink_frame.h"

#include <algorithm>

#include "drivers/mavlink/mavlink_layouts.h"

namespace drivers {
namespace {

constexpr std::uint8_t kStart = 0xFD, kSigned = 0x01;
constexpr std::size_t kHeader = 10, kChecksum = 2, kSignature = 13;

const MavlinkLayout* layout_of(std::uint32_t id) noexcept {
  const auto found = std::lower_bound(kMavlinkLayouts.begin(), kMavlinkLayouts.end(), id,
                                      [](const MavlinkLayout& layout, std::uint32_t i) { return layout.id < i; });
  return found != kMavlinkLayouts.end() && found->id == id ? &*found : nullptr;
}

std::uint16_t accumulate(std::uint16_t crc, std::uint8_t byte) noexcept {
  auto t = static_cast<std::uint8_t>(byte ^ (crc & 0xFFU));
  t = static_cast<std::uint8_t>(t ^ (t << 4U));
  return static_cast<std::uint16_t>((crc >> 8U) ^ (t << 8U) ^ (t << 3U) ^ (t >> 4U));
}

}  // namespace

std::uint16_t mavlink_checksum(std::span<const std::uint8_t> bytes, std::uint8_t crc_extra) noexcept {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) crc = accumulate(crc, byte);
  return accumulate(crc, crc_extra);
}

std::size_t write_mavlink(const MavlinkFrame& frame, std::array<std::uint8_t, kMavlinkMostBytes>& out) noexcept {
  const MavlinkLayout* layout = layout_of(frame.id);
  if (layout == nullptr) return 0;
  std::size_t length = layout->size;
  while (length > 1 && frame.payload[length - 1] == 0) --length;
  out = {};
  out[0] = kStart, out[1] = static_cast<std::uint8_t>(length);
  out[4] = frame.sequence, out[5] = frame.system, out[6] = frame.component;
  for (std::size_t i = 0; i < 3; ++i) out[7 + i] = static_cast<std::uint8_t>(frame.id >> (8 * i));
  std::copy_n(frame.payload.begin(), length, out.begin() + kHeader);
  const std::uint16_t crc = mavlink_checksum(std::span(out).subspan(1, kHeader - 1 + length), layout->crc_extra);
  out[kHeader + length] = static_cast<std::uint8_t>(crc & 0xFFU);
  out[kHeader + length + 1] = static_cast<std::uint8_t>(crc >> 8U);
  return kHeader + length + kChecksum;
}

void MavlinkParser::skip(std::size_t bytes) noexcept {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(bytes), buffer_.begin() + static_cast<std::ptrdiff_t>(n_),
            buffer_.begin());
  n_ -= bytes;
}

void MavlinkParser::end_datagram() noexcept {
  counts_.skipped_bytes += n_;
  n_ = 0;
}

bool MavlinkParser::take(MavlinkFrame& frame) noexcept {
  while (n_ > 0) {
    const auto no_frame = [&] {
      ++counts_.skipped_bytes;
      skip(1);
    };
    if (buffer_[0] != kStart || (n_ > 2 && (buffer_[2] & ~kSigned) != 0)) {
      no_frame();
      continue;
    }
    if (n_ < kHeader) return false;
    const auto byte = [&](std::size_t at) { return static_cast<std::uint32_t>(buffer_[at]); };
    const std::uint32_t id = byte(7) | byte(8) << 8U | byte(9) << 16U;
    const MavlinkLayout* layout = layout_of(id);
    if (layout == nullptr) {
      no_frame();
      continue;
    }
    const std::size_t length = buffer_[1];
    const std::size_t whole = kHeader + length + kChecksum + ((buffer_[2] & kSigned) != 0 ? kSignature : 0);
    if (n_ < whole) return false;
    const std::uint16_t crc = mavlink_checksum(std::span(buffer_).subspan(1, kHeader - 1 + length), layout->crc_extra);
    if (buffer_[kHeader + length] != (crc & 0xFFU) || buffer_[kHeader + length + 1] != crc >> 8U) {
      ++counts_.wrong_checksums;
      no_frame();
      continue;
    }
    frame = {.id = id, .sequence = buffer_[4], .system = buffer_[5], .component = buffer_[6], .payload = {}};
    std::copy_n(buffer_.begin() + kHeader, length, frame.payload.begin());
    ++counts_.frames;
    skip(whole);
    return true;
  }
  return false;
}

}  // namespace drivers
