#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/rotors/aircraft.h"
#include "core/types/attitude.h"

namespace drivers {

// Sends what an autopilot states on one LCM channel, for a service that listens to it: attitudes (attitude_t,
// camera.attitude_channel) or states of the aircraft (aircraft_t, camera.aircraft_channel). One thread.
class SampleSender {
 public:
  // Throws std::invalid_argument for a wrong URL or channel, std::runtime_error where the network cannot be used.
  SampleSender(const std::string& url, const std::string& channel);
  ~SampleSender();
  SampleSender(const SampleSender&) = delete;
  SampleSender& operator=(const SampleSender&) = delete;

  bool send(const core::AttitudeSample& sample);  // false: not sent
  bool send(const core::AircraftState& state);
  [[nodiscard]] std::uint64_t n_failed() const noexcept { return n_failed_; }

 private:
  template <class Message>
  bool send_message(const Message& message);

  struct Handle;
  std::unique_ptr<Handle> handle_;
  std::string channel_;
  std::uint64_t n_failed_ = 0;
};

}  // namespace drivers
