#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/topics.h"
#include "hovermodal/aircraft_t.hpp"
#include "hovermodal/attitude_t.hpp"
#include "tests/support/telemetry_samples.h"

namespace tests {

using Bytes = std::vector<std::uint8_t>;

template <class Message>
[[nodiscard]] Bytes encoded_bytes(const Message& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

struct HostileMessage {
  std::size_t kind = 0;  // of HostileMessages::kKinds
  std::string channel;
  Bytes bytes;
};

// Messages of every type that are wrong in one of many ways. The same seed gives the same messages. A flipped bit may
// leave a valid message.
class HostileMessages {
 public:
  static constexpr std::array<const char*, 7> kKinds{
      "wrong fingerprint", "truncated", "oversized length", "flipped bits", "random", "lengthened", "empty"};
  static constexpr std::size_t kAttitude = drivers::kTopics, kAircraft = kAttitude + 1;

  explicit HostileMessages(std::uint32_t seed, const std::string& prefix = "HOVERMODAL",
                           const std::string& attitude_channel = "ATTITUDE",
                           const std::string& aircraft_channel = "AIRCRAFT")
      : random_(seed) {
    const drivers::StreamIdentity identity{"hostile", 1};
    const auto channels = sample_channels(4);
    const std::array<Bytes, kAircraft + 1> good{
        encoded_bytes(drivers::to_messages(sample_estimate(4, 3), channels, identity).at(0)),
        encoded_bytes(drivers::to_message(sample_displacement(4, 1), identity)),
        encoded_bytes(drivers::to_messages(sample_sums(2, 16), channels, identity).at(0)),
        encoded_bytes(drivers::to_message(sample_tracks(6, 1), identity)),
        encoded_bytes(drivers::to_message(sample_closure(2, 1), identity)),
        encoded_bytes(drivers::to_message(sample_health("running", 1), channels, identity)),
        encoded_bytes(drivers::to_message(sample_preview(1), {}, identity)),
        encoded_bytes(hovermodal::attitude_t{1, {1.0, 0.0, 0.0, 0.0}}),
        encoded_bytes(hovermodal::aircraft_t{1, 47.5, 8.5, 24.0, 4.0, 310.0, 2, {95.0, 96.0}})};
    for (std::size_t i = 0; i < kAttitude; ++i)
      good_.emplace_back(drivers::topic_channel(prefix, static_cast<drivers::Topic>(i)), good[i]);
    good_.emplace_back(attitude_channel, good[kAttitude]);
    good_.emplace_back(aircraft_channel, good[kAircraft]);
  }

  // A valid message of each type with its channel.
  [[nodiscard]] const std::vector<std::pair<std::string, Bytes>>& good() const { return good_; }

  [[nodiscard]] HostileMessage next() {
    const auto& [channel, good] = good_[below(good_.size())];
    HostileMessage out{below(kKinds.size()), channel, good};
    spoil(out.kind, out.bytes);
    return out;
  }
  [[nodiscard]] std::size_t below(std::size_t n) { return random_() % n; }
  [[nodiscard]] std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }

 private:
  void spoil(std::size_t kind, Bytes& bytes) {
    constexpr std::array<std::uint32_t, 6> kLengths{0, 0xFFFFFFFFU, 0x80000000U, 0x7FFFFFFFU, 0x7FFF7FFFU, 0x80008000U};
    switch (kind) {
      case 0:
        bytes[below(8)] ^= static_cast<std::uint8_t>(1 + below(255));
        break;
      case 1:
        bytes.resize(below(bytes.size()));
        break;
      case 2: {
        const std::size_t at = 8 + below(bytes.size() - 11);
        const std::uint32_t value = kLengths[below(kLengths.size())];
        for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (24U - 8U * i));
        break;
      }
      case 3:
        for (std::size_t i = 0, n = 1 + below(8); i < n; ++i)
          bytes[8 + below(bytes.size() - 8)] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 4:
        bytes.resize(8 + below(200));
        for (std::size_t i = 8; i < bytes.size(); ++i) bytes[i] = byte();  // after a correct fingerprint
        break;
      case 5:
        for (std::size_t i = 0, n = 1 + below(40); i < n; ++i) bytes.push_back(byte());
        break;
      default:
        bytes.clear();
        break;
    }
  }

  std::mt19937 random_;
  std::vector<std::pair<std::string, Bytes>> good_;
};

}  // namespace tests
