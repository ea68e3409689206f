#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "drivers/telemetry/decode.h"
#include "drivers/telemetry/encode_flight.h"
#include "drivers/telemetry/sample_listener.h"

namespace drivers {

// Decodes received bytes into the ring. Accepts any bytes. One thread receives; counts() from any thread.
template <class Message, class Sample, std::size_t kRoom>
class SampleInbox {
 public:
  static constexpr std::size_t kSlots = kRoom;

  void receive(const void* data, std::size_t n_bytes) noexcept {
    const auto message = decode_message<Message>(data, n_bytes);
    Sample sample;
    if (!message || !take_sample(*message, sample)) return add(undecodable_);
    Sample* slot = writer_.try_claim();
    if (slot == nullptr) return add(dropped_);
    *slot = sample;
    writer_.publish();
    add(received_);
  }
  [[nodiscard]] rt::RingReader<Sample> samples() noexcept { return ring_.reader(); }
  [[nodiscard]] ListenerCounts counts() const noexcept {
    return {received_.load(std::memory_order_relaxed), undecodable_.load(std::memory_order_relaxed),
            dropped_.load(std::memory_order_relaxed)};
  }

 private:
  // Written by one thread; relaxed: independent of other data.
  static void add(std::atomic<std::uint64_t>& count) noexcept {
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  rt::SpscRing<Sample> ring_{kRoom, Sample{}};
  rt::RingWriter<Sample> writer_ = ring_.writer();
  std::atomic<std::uint64_t> received_{0}, undecodable_{0}, dropped_{0};
};

using AttitudeInbox = SampleInbox<hovermodal::attitude_t, core::AttitudeSample, 1024>;  // five seconds at 200 Hz
using AircraftInbox = SampleInbox<hovermodal::aircraft_t, core::AircraftState, 64>;     // one a second

}  // namespace drivers
