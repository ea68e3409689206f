#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/rotors/aircraft.h"
#include "core/types/attitude.h"
#include "rt/spsc_ring.h"

namespace drivers {

struct ListenerCounts {
  std::uint64_t received = 0;     // in the ring
  std::uint64_t undecodable = 0;  // another message, or values that cannot be
  std::uint64_t dropped = 0;      // ring full
};

// Samples sent by another program over LCM: data, never a command. A thread of the listener receives them and puts
// them into a ring, from which the holder of the reader takes them. If nobody does, or too slowly, the newest are
// dropped and counted.
template <class Sample>
class SampleListener {
 public:
  virtual ~SampleListener() = default;
  [[nodiscard]] virtual rt::RingReader<Sample> samples() = 0;        // once
  [[nodiscard]] virtual ListenerCounts counts() const noexcept = 0;  // any thread
};
using AttitudeListener = SampleListener<core::AttitudeSample>;  // attitude_t
using AircraftListener = SampleListener<core::AircraftState>;   // aircraft_t

// Both listen until destroyed. They throw std::invalid_argument for a wrong URL or channel, std::runtime_error where
// the network cannot be used or this build has no LCM.
[[nodiscard]] std::unique_ptr<AttitudeListener> listen_for_attitude(const std::string& url, const std::string& channel);
[[nodiscard]] std::unique_ptr<AircraftListener> listen_for_aircraft(const std::string& url, const std::string& channel);

}  // namespace drivers
