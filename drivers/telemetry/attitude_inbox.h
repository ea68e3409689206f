#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>

#include "drivers/telemetry/attitude_listener.h"
#include "drivers/telemetry/decode.h"
#include "hovermodal/attitude_t.hpp"

namespace drivers {

// Decodes received bytes into the ring. Accepts any bytes. One thread receives; counts() from any thread.
class AttitudeInbox {
 public:
  static constexpr std::size_t kSlots = 1024;  // five seconds at 200 Hz

  void receive(const void* data, std::size_t n_bytes) noexcept {
    const auto message = decode_message<hovermodal::attitude_t>(data, n_bytes);
    double squares = 0.0;
    if (message) {
      for (const double part : message->wxyz) squares += part * part;
    }
    if (!(squares > 1e-6) || !(squares < 1e12)) {
      add(undecodable_);
      return;
    }
    core::AttitudeSample* slot = writer_.try_claim();
    if (slot == nullptr) {
      add(dropped_);
      return;
    }
    slot->t_s = 1e-9 * static_cast<double>(message->time_ns);
    for (std::size_t i = 0; i < slot->wxyz.size(); ++i) slot->wxyz[i] = message->wxyz[i];
    writer_.publish();
    add(received_);
  }
  [[nodiscard]] rt::RingReader<core::AttitudeSample> samples() noexcept { return ring_.reader(); }
  [[nodiscard]] AttitudeListener::Counts counts() const noexcept {
    return {received_.load(std::memory_order_relaxed), undecodable_.load(std::memory_order_relaxed),
            dropped_.load(std::memory_order_relaxed)};
  }

 private:
  // Written by one thread; relaxed: independent of other data.
  static void add(std::atomic<std::uint64_t>& count) noexcept {
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  rt::SpscRing<core::AttitudeSample> ring_{kSlots, core::AttitudeSample{}};
  rt::RingWriter<core::AttitudeSample> writer_ = ring_.writer();
  std::atomic<std::uint64_t> received_{0}, undecodable_{0}, dropped_{0};
};

}  // namespace drivers
