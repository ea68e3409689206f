#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace drivers {

// Assembles LCM messages from the datagrams of its UDP multicast: a short message is one datagram, a long one several
// fragments. Replaces liblcm 1.3.1, which trusts the content of a datagram: a fragment with an impossible offset or
// length terminates every program that listens through it. Accepts any bytes; invalid ones are counted. One
// thread.
class LcmDatagrams {
 public:
  static constexpr std::size_t kMostOpen = 32;          // long messages whose fragments are incomplete
  static constexpr std::size_t kLongestChannel = 63;    // LCM's own limit
  static constexpr std::size_t kMostBytes = 1U << 20U;  // largest message

  // `data` is valid during the call only.
  using Receive = std::function<void(std::string_view lcm_channel, const void* data, std::size_t n_bytes)>;

  explicit LcmDatagrams(Receive receive) : receive_(std::move(receive)) {}

  // `sender`: any number that differs from sender to sender.
  void take(const void* datagram, std::size_t n_bytes, std::uint64_t sender);

  [[nodiscard]] std::uint64_t n_malformed() const noexcept { return n_malformed_; }
  // Long messages of which a fragment was lost, or that were displaced by newer ones.
  [[nodiscard]] std::uint64_t n_incomplete() const noexcept { return n_incomplete_; }

 private:
  struct Open {
    std::uint64_t sender = 0;
    std::uint32_t number = 0;
    std::string channel;  // with the first fragment
    std::vector<std::uint8_t> data;
    std::vector<bool> has;  // per fragment
    std::size_t n_missing = 0, n_bytes = 0;
  };

  void take_whole(const std::uint8_t* bytes, std::size_t n);
  void take_fragment(const std::uint8_t* bytes, std::size_t n, std::uint64_t sender);
  [[nodiscard]] std::deque<Open>::iterator open_message(std::uint64_t sender, std::uint32_t number, std::size_t size,
                                                        std::size_t n_fragments);

  Receive receive_;
  std::deque<Open> open_;  // the oldest first
  std::uint64_t n_malformed_ = 0, n_incomplete_ = 0;
};

}  // namespace drivers
