#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/types/attitude.h"
#include "rt/spsc_ring.h"

namespace drivers {

// Attitudes sent by another program over LCM (attitude_t): data, never a command. A thread of the listener receives
// them and puts them into a ring, from which the holder of the reader takes them. If nobody does, or too slowly, the
// newest are dropped and counted.
class AttitudeListener {
 public:
  struct Counts {
    std::uint64_t received = 0;     // in the ring
    std::uint64_t undecodable = 0;  // no such message, or no valid attitude (not finite, zero length)
    std::uint64_t dropped = 0;      // ring full
  };

  virtual ~AttitudeListener() = default;
  [[nodiscard]] virtual rt::RingReader<core::AttitudeSample> samples() = 0;  // once
  [[nodiscard]] virtual Counts counts() const noexcept = 0;                  // any thread
};

// Listens until destroyed. Throws std::invalid_argument for a wrong URL or channel, std::runtime_error where the
// network cannot be used or this build has no LCM.
[[nodiscard]] std::unique_ptr<AttitudeListener> listen_for_attitude(const std::string& url, const std::string& channel);

}  // namespace drivers
