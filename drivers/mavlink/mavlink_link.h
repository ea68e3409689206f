#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace drivers {

// A way over which MAVLink comes and goes. Written as MAVLink's tools write it:
//   udpin:ADDRESS:PORT    waits for datagrams at this address of this computer; answers to whoever sent the first one
//   udpout:HOST:PORT      sends to HOST, and takes what comes back
//   tcp:HOST:PORT         connects; when the connection ends, again every second
//   serial:DEVICE:BAUD    a serial line, 8N1, without flow control
// Only what is named here is opened. One thread.
class MavlinkLink {
 public:
  // Throws std::invalid_argument for a way that is none of these, std::runtime_error where it cannot be opened (a TCP
  // connection is tried later).
  [[nodiscard]] static std::unique_ptr<MavlinkLink> open(const std::string& way);
  virtual ~MavlinkLink() = default;

  // Waits for bytes, at most so long; 0: none came. At most one datagram, which then ends.
  [[nodiscard]] virtual std::size_t receive(std::span<std::uint8_t> bytes, int timeout_ms) = 0;
  // False: not sent, because there is nobody yet, or the line is full.
  virtual bool send(std::span<const std::uint8_t> bytes) = 0;
  [[nodiscard]] virtual bool is_datagrams() const noexcept = 0;
  // Datagrams from others than the first sender, which are not read.
  [[nodiscard]] virtual std::uint64_t from_others() const noexcept { return 0; }
};

}  // namespace drivers
